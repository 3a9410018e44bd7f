from .parquet import (
    channels_bytes as channels_bytes,
    parquet_bytes as parquet_bytes,
    read_parquet as read_parquet,
)
from .plausibility import (
    LARGEST as LARGEST,
    LONGEST_RECORD as LONGEST_RECORD,
    STATES as STATES,
    Implausible as Implausible,
    beyond as beyond,
    implausible_time as implausible_time,
    implausible_unit as implausible_unit,
    state_kind as state_kind,
)
from .recording import (
    BRAKE_COMMAND_TIME as BRAKE_COMMAND_TIME,
    ORIGIN as ORIGIN,
    SAMPLE_INTERVALS as SAMPLE_INTERVALS,
    TIME as TIME,
    TRACK_BRAKES_BESIDE as TRACK_BRAKES_BESIDE,
    Contents as Contents,
    Group as Group,
    Recording as Recording,
    Samples as Samples,
    recording_of as recording_of,
)
