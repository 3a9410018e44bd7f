"""Plan a sweep: its file, its axes and draws, and the values of each case."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
