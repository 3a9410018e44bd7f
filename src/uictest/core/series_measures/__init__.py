"""What a series of stops says of a WSP: measures over the dry and wet stops from one or more speeds."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
