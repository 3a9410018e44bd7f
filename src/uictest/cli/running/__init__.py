"""Behind `uictest run` and `uictest evaluate`: a batch from its cases or recordings to the published reports.

Names are imported when they are first used: every command loads the face, few need what lies behind it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
