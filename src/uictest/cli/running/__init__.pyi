from .baseline import (
    BaselineChoice as BaselineChoice,
    accept_or_compare as accept_or_compare,
    open_baseline as open_baseline,
    scope_of as scope_of,
)
from .batch import Batch as Batch, run_batch as run_batch
from .display import Display as Display, chosen_display as chosen_display
from .last_failed import failed_last as failed_last
from .recorded_batch import (
    CaseOfStop as CaseOfStop,
    RecordedBatch as RecordedBatch,
    RecordedFile as RecordedFile,
    read_files as read_files,
    run_recorded as run_recorded,
    write_preparation as write_preparation,
)
