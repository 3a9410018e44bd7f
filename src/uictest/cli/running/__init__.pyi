from .baseline import (
    BaselineChoice as BaselineChoice,
    accept_or_compare as accept_or_compare,
    open_baseline as open_baseline,
    scope_of as scope_of,
)
from .display import Display as Display, chosen_display as chosen_display
from .last_failed import failed_last as failed_last
from .shown_run import (
    judge_and_show as judge_and_show,
    publish_and_show as publish_and_show,
    write_preparation as write_preparation,
)
