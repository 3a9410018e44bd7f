from .channel_map import (
    ChannelMap as ChannelMap,
    Preparation as Preparation,
    load_map as load_map,
    presets as presets,
)
from .channel_map_schema import channel_map_schema as channel_map_schema
from .channels import WHEELSETS as WHEELSETS, of_wheelsets as of_wheelsets
from .conditions import REQUIRED_STATEMENTS as REQUIRED_STATEMENTS, stated_case as stated_case
from .defect import Defect as Defect
from .description import recorded_description as recorded_description
from .judgement import (
    judge_recording as judge_recording,
    unusable_result as unusable_result,
)
from .proposal import (
    channel_rows as channel_rows,
    fitting_preset as fitting_preset,
    lacks_speeds as lacks_speeds,
    proposed_map as proposed_map,
    remarks as remarks,
)
from .raw_channels import MapError as MapError, RawChannel as RawChannel, select_channels as select_channels
from .recorded_stop import (
    RecordedStop as RecordedStop,
    UnusableError as UnusableError,
    digest_of as digest_of,
    prepare as prepare,
    stop_in as stop_in,
)
