from .check import (
    Answer as Answer,
    Check as Check,
    Finding as Finding,
    NotCheckedError as NotCheckedError,
    Status as Status,
)
from .examination import Examination as Examination, all_checks as all_checks, examine as examine
from .known_stops import KnownStops as KnownStops
from .reference import REFERENCE as REFERENCE, computed_reference as computed_reference
from .report import finding_table as finding_table, findings_json as findings_json, junit_xml as junit_xml
