"""The rig of one case as an FMU for co-simulation: its machine code behind the functions of FMI."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
