from .balances import FitError as FitError
from .fit import COVERED as COVERED, Fit as Fit, fit_stop as fit_stop
from .outputs import (
    agreement as agreement,
    fit_document as fit_document,
    fitted_yaml as fitted_yaml,
    overlay as overlay,
)
