"""Recorded stops: from the channels of a file to samples, measures and verdicts.

A channel map names the channels and states trigger, raster, filter and standstill. Defects are reported,
gaps are never filled. The code that judges simulated stops judges recorded ones, too.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
