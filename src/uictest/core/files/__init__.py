"""Every file and folder that uictest writes or removes.

A folder that the user names is opened once, links included; no name below it leads through a link. Files
appear whole or not at all. What is removed was written by uictest and is still as it was written.

Names are imported when they are first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
