from .counting import SeriesStop as SeriesStop, observed_stops as observed_stops
from .judgement import judge_results as judge_results, judge_series as judge_series
from .programme import (
    JudgedTest as JudgedTest,
    Limits as Limits,
    braking_distance as braking_distance,
    judge_programme as judge_programme,
)
from .result import (
    SeriesCase as SeriesCase,
    SeriesResult as SeriesResult,
    SeriesVerdict as SeriesVerdict,
    SpeedResult as SpeedResult,
    StopCounts as StopCounts,
    UncountedStop as UncountedStop,
    series_document as series_document,
    series_results_of as series_results_of,
)
