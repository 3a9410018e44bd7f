"""index.html: one page that explains a run or a sweep at a glance and needs nothing but itself."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
