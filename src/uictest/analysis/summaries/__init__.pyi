from .frontier import (
    FrontierError as FrontierError,
    FrontierSearch as FrontierSearch,
    verdicts_of as verdicts_of,
)
from .summary import SweepSummary as SweepSummary, summarized as summarized
from .worst import full_cases as full_cases
