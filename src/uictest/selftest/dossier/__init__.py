"""One archive for an assessor: what this installation is, what it answers, what it must do and gets wrong.

Everything in it is read from the installed package; nothing names a folder or the host of the machine.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
