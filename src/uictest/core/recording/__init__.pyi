from .formats.parquet import (
    channels_bytes as channels_bytes,
    parquet_bytes as parquet_bytes,
    read_parquet as read_parquet,
)
from .instants import (
    at_instants as at_instants,
    coarser as coarser,
    common_instants as common_instants,
    covers as covers,
    mean_interval as mean_interval,
    rows_at as rows_at,
    usual_interval as usual_interval,
)
from .plausibility import (
    LARGEST as LARGEST,
    LONGEST_RECORD as LONGEST_RECORD,
    Implausible as Implausible,
    beyond as beyond,
    implausible_time as implausible_time,
    implausible_unit as implausible_unit,
    state_kind as state_kind,
    states_of as states_of,
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
    numbers_of as numbers_of,
    recording_of as recording_of,
)
