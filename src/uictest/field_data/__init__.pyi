from .channel_map import ChannelMap as ChannelMap, load_map as load_map, presets as presets
from .channels import WHEELSETS as WHEELSETS, of_wheelsets as of_wheelsets
from .conditions import FACTS as FACTS, stated_case as stated_case
from .defect import Defect as Defect
from .file import digest_of as digest_of, stop_in as stop_in
from .judgement import (
    judge_recording as judge_recording,
    judge_stop as judge_stop,
    unusable_result as unusable_result,
)
from .preparation import Preparation as Preparation
from .prepare import RecordedStop as RecordedStop, UnusableError as UnusableError, prepare as prepare
from .proposal import (
    fitting_preset as fitting_preset,
    lacks_essentials as lacks_essentials,
    listing as listing,
    proposed_map as proposed_map,
    remarks as remarks,
)
from .raw import MapError as MapError, RawChannel as RawChannel, select as select
from .subject import recorded_subject as recorded_subject
