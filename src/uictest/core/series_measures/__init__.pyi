from .catalogue import SERIES_MEASURES as SERIES_MEASURES
from .measure import (
    CountedStop as CountedStop,
    Estimate as Estimate,
    Figure as Figure,
    Method as Method,
    Rail as Rail,
    SeriesMeasure as SeriesMeasure,
    SeriesValue as SeriesValue,
    SpeedStops as SpeedStops,
    dry_relation as dry_relation,
    largest_of_wheelsets as largest_of_wheelsets,
    mean_of as mean_of,
    median_of as median_of,
    of_stop as of_stop,
    percent_of_dry as percent_of_dry,
)
