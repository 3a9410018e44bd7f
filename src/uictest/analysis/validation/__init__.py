"""Recorded stops against their simulation: how far off the model is, and where that has been shown.

A validation file or a series names the recordings and their scenarios (:mod:`.plan`). Each recorded stop is
simulated; what differs is summed up per figure (:mod:`.agreement`), and the conditions of the stops bound the
domain in which it holds (:mod:`.domain`).
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
