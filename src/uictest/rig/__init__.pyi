from .assembly import (
    ASSIGNMENTS as ASSIGNMENTS,
    FRICTION_KEYS as FRICTION_KEYS,
    StopInputs as StopInputs,
    assemble as assemble,
    assigned as assigned,
    controller_of as controller_of,
    friction_laws as friction_laws,
)
from .backends.batch import BatchMeasures as BatchMeasures
from .backends.compiled import translate as translate
from .backends.cuda import cuda as cuda, run_on_gpu as run_on_gpu
from .backends.lanes import lanes_are_compiled as lanes_are_compiled, run_in_lanes as run_in_lanes
from .backends.native import stops_are_compiled as stops_are_compiled
from .derived_parameters import Assignment as Assignment
from .derived_wheelset_parameters import WHEELSET_ASSIGNMENTS as WHEELSET_ASSIGNMENTS
from .model.trace import CAR_CHANNELS as CAR_CHANNELS, WHEELSET_CHANNELS as WHEELSET_CHANNELS
from .recorded_rail import RecordedRail as RecordedRail
from .simulation import SimulatedStop as SimulatedStop, is_compiled as is_compiled, simulate as simulate
