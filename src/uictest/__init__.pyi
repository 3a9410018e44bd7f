from .api import (
    Results as Results,
    Rig as Rig,
    SweepResults as SweepResults,
    TrainRig as TrainRig,
    Validation as Validation,
    evaluate as evaluate,
    load as load,
    read_recording as read_recording,
    read_results as read_results,
    run as run,
    search as search,
    simulate as simulate,
    sweep as sweep,
    validate as validate,
)
from .core.recording import Recording as Recording
from .judging.evaluation import CaseResult as CaseResult
from .plans.scenario import Case as Case, ScenarioErrors as ScenarioErrors

__version__: str
