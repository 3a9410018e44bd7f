from .api import (
    Results as Results,
    SweepResults as SweepResults,
    Validation as Validation,
    evaluate as evaluate,
    load as load,
    read_recording as read_recording,
    read_results as read_results,
    run as run,
    simulate as simulate,
    sweep as sweep,
    validate as validate,
)
from .evaluation import CaseResult as CaseResult
from .recording import Recording as Recording
from .scenario import Case as Case, ScenarioErrors as ScenarioErrors
from .stepping import Rig as Rig

__version__: str
