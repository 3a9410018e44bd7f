from .batch import (
    BatchResult as BatchResult,
    PartsOfCases as PartsOfCases,
    parts_of_cases as parts_of_cases,
    parts_of_recorded as parts_of_recorded,
    run_cases as run_cases,
    with_parts as with_parts,
)
from .case import CaseRun as CaseRun, RecordingRequest as RecordingRequest, run_case as run_case
from .repeats import Stop as Stop, case_of_stop as case_of_stop, stops_of as stops_of
from .requirement_coverage import (
    CoveredRequirement as CoveredRequirement,
    Verifier as Verifier,
    requirement_coverage as requirement_coverage,
)
from .selection import (
    ExpressionError as ExpressionError,
    Matches as Matches,
    by_expression as by_expression,
    by_id as by_id,
    by_tag as by_tag,
    descriptions_of as descriptions_of,
    parse as parse,
)
from .threaded_map import (
    ThreadedMap as ThreadedMap,
    map_on_threads as map_on_threads,
    replay as replay,
    shortest_cycle as shortest_cycle,
)
