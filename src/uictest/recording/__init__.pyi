from .atomic import (
    atomic_path as atomic_path,
    write_bytes_atomic as write_bytes_atomic,
    write_text_atomic as write_text_atomic,
)
from .contents import Contents as Contents, Group as Group, Samples as Samples
from .conversion import recording_of as recording_of
from .parquet import read_parquet as read_parquet, write_parquet as write_parquet
from .plausibility import (
    LARGEST as LARGEST,
    Implausible as Implausible,
    beyond as beyond,
    implausible_time as implausible_time,
    implausible_unit as implausible_unit,
)
from .recording import (
    BRAKE_COMMAND_TIME as BRAKE_COMMAND_TIME,
    ORIGIN as ORIGIN,
    TIME as TIME,
    Recording as Recording,
)
from .states import STATES as STATES, state_kind as state_kind
