from .loading import (
    load as load,
    read_recording as read_recording,
    read_results as read_results,
    simulate as simulate,
)
from .recorded import Validation as Validation, evaluate as evaluate, validate as validate
from .results import Results as Results
from .running import run as run
from .searching import search as search
from .stepping import Rig as Rig, TrainRig as TrainRig
from .sweeping import SweepResults as SweepResults, sweep as sweep
