from .catalogue import SERIES_MEASURES as SERIES_MEASURES
from .estimate import (
    Estimate as Estimate,
    Method as Method,
    SeriesValue as SeriesValue,
    mean_of as mean_of,
    median_of as median_of,
)
from .measure import (
    CountedStop as CountedStop,
    Rail as Rail,
    SeriesMeasure as SeriesMeasure,
    SpeedStops as SpeedStops,
    of_stop as of_stop,
)
