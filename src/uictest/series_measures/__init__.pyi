from .estimate import Estimate as Estimate, Method as Method, Statistic as Statistic
from .measure import SeriesMeasure as SeriesMeasure, SeriesValue as SeriesValue
from .registry import SERIES_MEASURES as SERIES_MEASURES
from .relation import dry_relation as dry_relation
from .stops import CountedStop as CountedStop, SpeedStops as SpeedStops
