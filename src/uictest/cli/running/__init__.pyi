from .display import Display as Display, chosen_display as chosen_display
from .earlier_runs import (
    BaselineChoice as BaselineChoice,
    accept_or_compare as accept_or_compare,
    failed_last as failed_last,
    open_baseline as open_baseline,
    scope_of as scope_of,
)
from .shown_run import (
    judge_and_show as judge_and_show,
    publish_and_show as publish_and_show,
    write_preparation as write_preparation,
)
