"""How a WSP fails: a guided search for the worst stop, and the smallest scenario that shows it."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
