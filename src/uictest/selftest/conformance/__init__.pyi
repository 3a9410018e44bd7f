from .checks import CHECKS as CHECKS, Check as Check
from .examination import Examination as Examination, Finding as Finding, Status as Status, examine as examine
from .report import finding_table as finding_table, findings_json as findings_json, junit_xml as junit_xml
from .subject import Subject as Subject, subject_of as subject_of
