from .channel_map import (
    CHANNEL_UNITS as CHANNEL_UNITS,
    WHEELSETS as WHEELSETS,
    ChannelMap as ChannelMap,
    ChannelSource as ChannelSource,
    Preparation as Preparation,
    channel_map_schema as channel_map_schema,
    load_map as load_map,
    of_wheelsets as of_wheelsets,
    presets as presets,
)
from .defects import Defect as Defect
from .judgement import (
    REQUIRED_STATEMENTS as REQUIRED_STATEMENTS,
    judge_recording as judge_recording,
    recorded_description as recorded_description,
    stated_case as stated_case,
)
from .proposal import (
    channel_rows as channel_rows,
    fitting_preset as fitting_preset,
    lacks_speeds as lacks_speeds,
    proposed_map as proposed_map,
    remarks as remarks,
)
from .raw_channels import (
    MapError as MapError,
    RawChannel as RawChannel,
    at_own_rates as at_own_rates,
    resampled as resampled,
    select_channels as select_channels,
)
from .recorded_stop import (
    RecordedStop as RecordedStop,
    UnusableError as UnusableError,
    digest_of as digest_of,
    prepare as prepare,
    stop_in as stop_in,
)
from .trigger import SHORTEST_APPLICATION as SHORTEST_APPLICATION
