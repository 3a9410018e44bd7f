"""Measured stops: from the channels of a file to samples, measures and verdicts.

A channel map names the channels; trigger, raster, filter and standstill are chosen in the open; defects are
found and named, never bridged. What comes out is judged by the code that judges simulated stops.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
