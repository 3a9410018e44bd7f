"""Conformance of WSP controllers: facts that every one of them should keep, checked without the rig.

A controller is driven through cycles whose speeds are given in advance (:mod:`.situations`); from what it has
answered every check of :mod:`.checks` reads one fact. A controller from outside runs in a child process.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
