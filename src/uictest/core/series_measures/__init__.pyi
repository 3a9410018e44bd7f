from .catalogue import SERIES_MEASURES as SERIES_MEASURES
from .estimate import (
    Estimate as Estimate,
    Method as Method,
    Statistic as Statistic,
    mean_of as mean_of,
    median_of as median_of,
)
from .measure import (
    CountedStop as CountedStop,
    Rail as Rail,
    SeriesMeasure as SeriesMeasure,
    SeriesValue as SeriesValue,
    SpeedStops as SpeedStops,
    dry_relation as dry_relation,
    of_stop as of_stop,
    percent_of_dry as percent_of_dry,
)
