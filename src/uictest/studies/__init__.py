"""The experiments of the paper and our own about its rig; each compares its values with the paper's."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
