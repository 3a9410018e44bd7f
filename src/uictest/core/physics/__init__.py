"""The parts of the rig, one per module, as pure scalar functions of floats.

Every function is written once, in terms of the operations of :mod:`uictest.core.physics.arithmetic`, so that
the same source runs as plain Python, compiled scalar code and SIMD lanes. Nothing here knows about
records, scenarios or units other than SI. Pressures are absolute unless a name says ``gauge``.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
