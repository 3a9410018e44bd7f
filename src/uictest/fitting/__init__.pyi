from .estimate import Fit as Fit, fit_stop as fit_stop
from .outputs import fit_document as fit_document, fitted_yaml as fitted_yaml
from .overlay import agreement as agreement, overlay as overlay
from .samples import FitError as FitError
