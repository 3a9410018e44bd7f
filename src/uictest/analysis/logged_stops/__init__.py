"""What the stops of a log show together: groups of dry and wet stops, the friction of each."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
