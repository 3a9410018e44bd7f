"""From scenario files, cases or recordings to a run that is judged, and to its reports.

What `uictest run`, `evaluate` and `sweep` do, without a terminal: an observer follows a run and shows it.
Names are imported when they are first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
