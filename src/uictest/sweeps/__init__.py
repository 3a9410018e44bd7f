"""Sweeps: one scenario with many values of its parameters, run in chunks that survive an interruption.

Names are imported when they are first used: checking a sweep file takes a fraction of the time of a run.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
