from .catalogue import SERIES_MEASURES as SERIES_MEASURES
from .measure import (
    CountedStop as CountedStop,
    Estimate as Estimate,
    Method as Method,
    Rail as Rail,
    SeriesMeasure as SeriesMeasure,
    SeriesValue as SeriesValue,
    SpeedStops as SpeedStops,
    mean_of as mean_of,
    median_of as median_of,
    of_stop as of_stop,
)
