from .check import Answer as Answer, Check as Check, NotCheckedError as NotCheckedError
from .examination import all_checks as all_checks, examine as examine
from .finding import Examination as Examination, Finding as Finding, Status as Status
from .known_stops import KnownStops as KnownStops
from .reference import REFERENCE as REFERENCE, computed_reference as computed_reference
from .report import (
    finding_document as finding_document,
    findings_json as findings_json,
    findings_suite as findings_suite,
)
