"""The rig stepped by somebody else's program: :class:`Rig` and what it shows."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
