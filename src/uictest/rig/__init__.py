"""The rig: parts coupled, stepped from the brake command to standstill."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
