from .engine import Engine as Engine, Findings as Findings
from .outcome import FoundCase as FoundCase, SearchOutcome as SearchOutcome
from .run import SearchRequest as SearchRequest, run_search as run_search
from .trials import ERROR as ERROR, Stop as Stop, Trial as Trial, Trials as Trials
