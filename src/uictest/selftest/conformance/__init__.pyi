from .checks import CHECKS as CHECKS, Check as Check
from .examination import examine as examine
from .subject import Subject as Subject, subject_of as subject_of
