"""Identification of hysteresis and cylinder dynamics from records, without the rig; results for the air."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
