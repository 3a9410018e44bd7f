"""The source's experiments, and ours about its rig: each runs, and says what the source has beside ours."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
