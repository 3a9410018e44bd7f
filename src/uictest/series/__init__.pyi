from .counting import SeriesStop as SeriesStop, observed_stops as observed_stops
from .document import (
    SCHEMA as SCHEMA,
    series_document as series_document,
    series_results_of as series_results_of,
)
from .judgement import judge_series as judge_series
from .plan.definition import load_series as load_series
from .plan.model import SERIES_SCHEMA as SERIES_SCHEMA, SeriesFile as SeriesFile, Stops as Stops
from .plan.schema import series_schema as series_schema
from .plan.series import PlannedStop as PlannedStop, Recorded as Recorded, Series as Series
from .plan.stop_entry import (
    recorded_by as recorded_by,
    scenario_of as scenario_of,
    values_set_by as values_set_by,
)
from .result import (
    Role as Role,
    SeriesCase as SeriesCase,
    SeriesResult as SeriesResult,
    SeriesVerdict as SeriesVerdict,
    SpeedResult as SpeedResult,
    StopCounts as StopCounts,
    UncountedStop as UncountedStop,
)
