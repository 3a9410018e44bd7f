from .choice import FORMATS as FORMATS, encoded as encoded, format_of as format_of, writer_of as writer_of
from .isolation import read_contents as read_contents
from .layout import Dialect as Dialect
from .problems import (
    MissingExtraError as MissingExtraError,
    ReadingInterruptedError as ReadingInterruptedError,
    UnreadableError as UnreadableError,
    required_module as required_module,
)
