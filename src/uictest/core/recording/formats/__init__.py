"""Measurement files: one module per format, each of which reads contents and writes a recording.

Foreign files are read in a process of their own, with bounded time and memory: a damaged or hostile file
costs a message, never the program.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
