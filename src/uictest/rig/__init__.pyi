from .assembly import (
    assemble as assemble,
    controller_config as controller_config,
    friction_laws as friction_laws,
    noise_key as noise_key,
    noise_key_text as noise_key_text,
)
from .external.drives import (
    Beginning as Beginning,
    Driven as Driven,
    DriveRequest as DriveRequest,
    drive as drive,
)
from .external.in_process import (
    BlockInputs as BlockInputs,
    BlockRun as BlockRun,
    check_requests as check_requests,
    empty_exchange as empty_exchange,
    run_block as run_block,
    run_in_process as run_in_process,
    run_train_in_process as run_train_in_process,
)
from .external.workers import (
    RunInputs as RunInputs,
    RunTrain as RunTrain,
    Workers as Workers,
    in_real_time as in_real_time,
)
from .kernel.arguments import placed as placed
from .kernel.library import (
    Built as Built,
    KernelError as KernelError,
    processor as processor,
    register_width as register_width,
    source_digest as source_digest,
)
from .model.controller import ALONE as ALONE, CHOICES as CHOICES, CONTROLLER_MEMORY as CONTROLLER_MEMORY
from .model.records import TrainRecords as TrainRecords
from .model.trace import CAR_CHANNELS as CAR_CHANNELS, WHEELSET_CHANNELS as WHEELSET_CHANNELS, Trace as Trace
from .rail_assembly import highest_creep_forces as highest_creep_forces
from .recorded_stop import (
    RecordedRail as RecordedRail,
    noted_numbers as noted_numbers,
    pass_samples as pass_samples,
)
from .reference_distance import (
    measures_with_reference as measures_with_reference,
    reference_distances as reference_distances,
    run_in_lanes as run_in_lanes,
)
from .simulation import (
    CouplerPeaks as CouplerPeaks,
    SimulatedStop as SimulatedStop,
    peaks_beside as peaks_beside,
    recording_of_stop as recording_of_stop,
    run_coupled as run_coupled,
    sha256_of_case as sha256_of_case,
    simulate as simulate,
    simulate_cars as simulate_cars,
    simulate_trains as simulate_trains,
)
from .stepped import SteppedTrain as SteppedTrain, train_memory as train_memory
from .train_assembly import Coupling as Coupling, assemble_train as assemble_train, coupling_of as coupling_of
from .train_stop import (
    STEP as STEP,
    FinishedStop as FinishedStop,
    StopInputs as StopInputs,
    TrainInputs as TrainInputs,
    TrainStop as TrainStop,
    alone as alone,
    compiled_rig as compiled_rig,
    empty_trace as empty_trace,
    stacked as stacked,
)
