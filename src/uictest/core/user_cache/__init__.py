"""The user's cache: compiled code, compiled templates and packed scripts, kept for later runs.

Cached content is executed or becomes part of a page. It is therefore read from and written to folders that
only this user can write, and a file is used only if it is intact and was made from the same inputs. All
access to these folders goes through this room.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
