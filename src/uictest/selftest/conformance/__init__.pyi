from .bench import Subject as Subject, subject_of as subject_of
from .checks import CHECKS as CHECKS, Check as Check
from .examining import examine as examine, examined as examined
from .page import examination_html as examination_html
