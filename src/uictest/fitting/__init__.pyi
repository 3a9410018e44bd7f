from .document import fit_document as fit_document
from .drawing import overlay_svg as overlay_svg
from .estimate import Fit as Fit
from .fit import fit_stop as fit_stop
from .fitted_scenario import fitted_yaml as fitted_yaml
from .overlay import agreement as agreement, overlay as overlay
from .samples import FitError as FitError
