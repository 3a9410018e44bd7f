from .estimate import (
    Estimate as Estimate,
    Method as Method,
    Statistic as Statistic,
    mean_of as mean_of,
    median_of as median_of,
)
from .measure import SeriesMeasure as SeriesMeasure, SeriesValue as SeriesValue
from .registry import SERIES_MEASURES as SERIES_MEASURES
from .relation import dry_relation as dry_relation, percent_of_dry as percent_of_dry
from .stops import (
    CountedStop as CountedStop,
    Rail as Rail,
    SpeedStops as SpeedStops,
    of_stop as of_stop,
)
