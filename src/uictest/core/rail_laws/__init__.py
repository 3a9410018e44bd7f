"""Laws of the rail that sliding changes: a module here states the numbers and the equations of one."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
