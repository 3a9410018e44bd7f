from .evaluating import evaluate as evaluate
from .loading import load as load
from .reading import read_recording as read_recording, read_results as read_results
from .results import Results as Results
from .running import run as run
from .simulating import simulate as simulate
from .sweep_results import SweepResults as SweepResults
from .sweeping import sweep as sweep
from .validating import validate as validate
from .validation_results import Validation as Validation
