"""Two runs or two recordings side by side, and what between them is out of tolerance."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
