"""What a search varies: its section, checked, and the space between vectors and values as written."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
