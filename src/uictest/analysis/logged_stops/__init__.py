"""What the stops of a log show together: wheelsets beside their neighbours, the rail, groups of stops."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
