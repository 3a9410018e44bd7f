from .assembly import (
    ASSIGNMENTS as ASSIGNMENTS,
    FRICTION_KEYS as FRICTION_KEYS,
    assemble as assemble,
    assigned as assigned,
    controller_config as controller_config,
    friction_laws as friction_laws,
)
from .backends.lanes import (
    TrainMeasures as TrainMeasures,
    run_trains_in_lanes as run_trains_in_lanes,
)
from .backends.replayed import noted_numbers as noted_numbers, pass_samples as pass_samples
from .backends.stepped import (
    SteppedTrain as SteppedTrain,
    train_memory as train_memory,
)
from .backends.stops import STEP as STEP, compiled_rig as compiled_rig
from .controller_alone import (
    ALONE as ALONE,
    CONTROLLER_MEMORY as CONTROLLER_MEMORY,
)
from .coupled_cars import (
    CouplerPeaks as CouplerPeaks,
    peaks_beside as peaks_beside,
    run_coupled as run_coupled,
)
from .derived_parameters import Assignment as Assignment
from .derived_wheelset_parameters import WHEELSET_ASSIGNMENTS as WHEELSET_ASSIGNMENTS
from .external.block import (
    BlockInputs as BlockInputs,
    BlockRun as BlockRun,
    run_block as run_block,
)
from .external.drives import (
    Beginning as Beginning,
    Driven as Driven,
    DriveRequest as DriveRequest,
    drive as drive,
)
from .external.in_process import (
    check_requests as check_requests,
    empty_exchange as empty_exchange,
    run_in_process as run_in_process,
    run_train_in_process as run_train_in_process,
)
from .external.workers import (
    RunInputs as RunInputs,
    RunTrain as RunTrain,
    Workers as Workers,
    in_real_time as in_real_time,
)
from .highest_creep import highest_creep_forces as highest_creep_forces
from .kernel.arguments import placed as placed
from .kernel.built import Built as Built, KernelError as KernelError, source_digest as source_digest
from .kernel.library import processor as processor, register_width as register_width
from .model.controller import CHOICES as CHOICES
from .model.records import TrainRecords as TrainRecords
from .model.trace import (
    CAR_CHANNELS as CAR_CHANNELS,
    WHEELSET_CHANNELS as WHEELSET_CHANNELS,
    Trace as Trace,
)
from .recorded_rail import RecordedRail as RecordedRail
from .reference_distance import (
    measures_with_reference as measures_with_reference,
    reference_distances as reference_distances,
    run_in_lanes as run_in_lanes,
)
from .simulation import (
    SimulatedStop as SimulatedStop,
    recording_of_stop as recording_of_stop,
    sha256_of_case as sha256_of_case,
    simulate as simulate,
    simulate_cars as simulate_cars,
    simulate_trains as simulate_trains,
)
from .single_stop import (
    FinishedStop as FinishedStop,
    StopInputs as StopInputs,
    noise_key_text as noise_key_text,
    noise_keys as noise_keys,
)
from .train_inputs import (
    Coupling as Coupling,
    assemble_train as assemble_train,
    coupling_of as coupling_of,
)
from .train_stop import (
    TrainInputs as TrainInputs,
    TrainStop as TrainStop,
    alone as alone,
    empty_trace as empty_trace,
)
