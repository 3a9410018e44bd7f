"""Series of stops: a dry reference and wet stops, judged together to say how good a WSP is."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
