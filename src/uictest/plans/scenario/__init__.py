"""What a user writes: scenario files, read with positions, checked, and expanded into cases."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
