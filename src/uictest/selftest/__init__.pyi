from .check import Answer as Answer, Check as Check, NotCheckedError as NotCheckedError
from .checks import all_checks as all_checks
from .examination import Examination as Examination, examine as examine
from .finding import Finding as Finding, Status as Status
from .known_stops import KnownStops as KnownStops
from .reference import REFERENCE as REFERENCE, computed_reference as computed_reference
from .report import finding_table as finding_table, findings_json as findings_json, junit_xml as junit_xml
