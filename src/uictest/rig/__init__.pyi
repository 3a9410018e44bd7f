from .assembly import (
    ASSIGNMENTS as ASSIGNMENTS,
    FRICTION_KEYS as FRICTION_KEYS,
    StopInputs as StopInputs,
    assemble as assemble,
    assigned as assigned,
    controller_config as controller_config,
    controller_of as controller_of,
    friction_laws as friction_laws,
    sha256_of_case as sha256_of_case,
)
from .backends.batch import BatchMeasures as BatchMeasures
from .backends.compiled import translate as translate
from .backends.cuda import cuda as cuda, run_on_gpu as run_on_gpu
from .backends.lanes import (
    lanes_are_compiled as lanes_are_compiled,
    load_lanes as load_lanes,
    run_in_lanes as run_in_lanes,
)
from .backends.machine_code import Target as Target
from .backends.native import stops_are_compiled as stops_are_compiled
from .backends.stepped import (
    STEP_ARGUMENTS as STEP_ARGUMENTS,
    STEP_NAME as STEP_NAME,
    STOP_MEMORY as STOP_MEMORY,
    SteppedStop as SteppedStop,
    stepping_code as stepping_code,
    stepping_is_compiled as stepping_is_compiled,
)
from .derived_parameters import Assignment as Assignment
from .derived_wheelset_parameters import WHEELSET_ASSIGNMENTS as WHEELSET_ASSIGNMENTS
from .external.block import (
    BlockInputs as BlockInputs,
    BlockRun as BlockRun,
    block_is_compiled as block_is_compiled,
    load_block as load_block,
    run_block as run_block,
)
from .external.drive import (
    Beginning as Beginning,
    Driven as Driven,
    DriveRequest as DriveRequest,
    Drives as Drives,
    drive as drive,
)
from .external.in_process import (
    RunInputs as RunInputs,
    in_real_time as in_real_time,
    run_in_process as run_in_process,
)
from .external.opened import empty_exchange as empty_exchange
from .external.workers import Workers as Workers
from .highest_creep import highest_creep_forces as highest_creep_forces
from .model.trace import CAR_CHANNELS as CAR_CHANNELS, WHEELSET_CHANNELS as WHEELSET_CHANNELS
from .noise_key import noise_key_text as noise_key_text, noise_keys as noise_keys
from .recorded_rail import RecordedRail as RecordedRail
from .simulation import (
    SimulatedStop as SimulatedStop,
    is_compiled as is_compiled,
    recording_of_stop as recording_of_stop,
    simulate as simulate,
)
