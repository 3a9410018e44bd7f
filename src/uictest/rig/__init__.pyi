from .assembly import (
    FRICTION_KEYS as FRICTION_KEYS,
    SECTIONS as SECTIONS,
    assemble as assemble,
    friction_laws as friction_laws,
)
from .backends.compiled import translate as translate
from .backends.cuda import cuda as cuda, run_on_gpu as run_on_gpu
from .backends.lanes import (
    BatchMeasures as BatchMeasures,
    lanes_are_warm as lanes_are_warm,
    run_in_lanes as run_in_lanes,
)
from .backends.native import is_warm as is_warm
from .model.trace import CAR_CHANNELS as CAR_CHANNELS, WHEELSET_CHANNELS as WHEELSET_CHANNELS
from .simulation import SimulatedStop as SimulatedStop, simulate as simulate
