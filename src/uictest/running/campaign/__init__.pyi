from .batch import BatchResult as BatchResult, run_cases as run_cases
from .case import CaseRun as CaseRun, RecordingRequest as RecordingRequest, run_case as run_case
from .descriptions import descriptions_of as descriptions_of
from .expression import ExpressionError as ExpressionError, Matches as Matches, parse as parse
from .parts import (
    PartsOfCases as PartsOfCases,
    parts_of_cases as parts_of_cases,
    parts_of_recorded as parts_of_recorded,
    with_parts as with_parts,
)
from .repeats import Stop as Stop, case_of_stop as case_of_stop, stops_of as stops_of
from .replay import replay as replay, shortest_cycle as shortest_cycle
from .requirement_coverage import (
    CoveredRequirement as CoveredRequirement,
    Verifier as Verifier,
    requirement_coverage as requirement_coverage,
)
from .selection import by_expression as by_expression, by_id as by_id, by_tag as by_tag
from .threaded_map import ThreadedMap as ThreadedMap, map_on_threads as map_on_threads
