"""Batches of cases: selecting them, running them, keeping their results in order."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
