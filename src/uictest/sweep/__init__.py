"""Sweeps: one scenario with many values of its parameters, worked out in parts that survive anything.

Names are imported when they are first used: checking a sweep file takes a fraction of what running it does.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
