from .checks import CHECKS as CHECKS, Check as Check
from .examination import Examined as Examined, examine as examine, examined as examined
from .page import examination_html as examination_html
from .subject import Subject as Subject, subject_of as subject_of
