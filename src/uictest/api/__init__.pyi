from .evaluating import evaluate as evaluate
from .loading import load as load, simulate as simulate
from .reading import read_recording as read_recording, read_results as read_results
from .results import Results as Results
from .running import run as run
from .sweeping import SweepResults as SweepResults, sweep as sweep
from .validating import Validation as Validation, validate as validate
