"""Hysteresis and cylinder dynamics from records, whoever made them: this room knows no rig."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
