"""What is made once and kept for later runs: compiled code, compiled templates, packed scripts.

What is kept is executed, or becomes part of a page. So it is read from and written to folders that nobody
but this user can write, and only files that are intact and were made of the very inputs at hand are used.
This room is the only way to these folders.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
