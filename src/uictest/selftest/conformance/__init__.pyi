from .bench import Subject as Subject, subject_of as subject_of
from .checks import (
    CHECKS as CHECKS,
    Check as Check,
    examination_html as examination_html,
    examine as examine,
    examined as examined,
)
