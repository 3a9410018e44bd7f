from .batch import (
    NOT_JUDGED as NOT_JUDGED,
    BatchResult as BatchResult,
    RunSettings as RunSettings,
    ThreadedMap as ThreadedMap,
    judge_cases as judge_cases,
    map_on_threads as map_on_threads,
    parts_of_cases as parts_of_cases,
    parts_of_recorded as parts_of_recorded,
    replay as replay,
    run_cases as run_cases,
    shortest_cycle as shortest_cycle,
)
from .descriptions import descriptions_of as descriptions_of
from .requirement_coverage import (
    CoveredRequirement as CoveredRequirement,
    Verifier as Verifier,
    requirement_coverage as requirement_coverage,
)
from .selection import (
    ExpressionError as ExpressionError,
    Selectable as Selectable,
    by_expression as by_expression,
    by_id as by_id,
    by_tag as by_tag,
    mentioned_in as mentioned_in,
    parse as parse,
    selected as selected,
)
from .stop import (
    CaseRun as CaseRun,
    RecordingRequest as RecordingRequest,
    Stop as Stop,
    StopRun as StopRun,
    run_stop as run_stop,
    run_train as run_train,
    run_trains as run_trains,
    stops_of as stops_of,
    stops_together as stops_together,
    with_rails as with_rails,
)
