"""FMUs for co-simulation: the rig of one case, or a controller, with the functions of FMI."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
