from .cells import (
    DAY as DAY,
    Cells as Cells,
    are_dates as are_dates,
    is_clock as is_clock,
    seconds_of as seconds_of,
    written_as as written_as,
)
from .csv_text import INTERVAL as INTERVAL
from .file_formats import (
    FORMATS as FORMATS,
    MissingExtraError as MissingExtraError,
    ReadingInterruptedError as ReadingInterruptedError,
    UnreadableError as UnreadableError,
    encoded as encoded,
    format_of as format_of,
    required_module as required_module,
    writer_of as writer_of,
)
from .isolation import read_contents as read_contents
from .layout import Dialect as Dialect
from .pieces import read_pieces as read_pieces
