"""Measurement files: one module per format, each of which reads contents and writes a recording.

Foreign files are read in a process of their own, with bounded time and memory: a damaged or hostile file
costs a message, never the program.
"""

from uictest.recording.formats.choice import FORMATS, SUFFIXES, format_of, writer_of
from uictest.recording.formats.dialect import Dialect
from uictest.recording.formats.isolation import read_contents
from uictest.recording.formats.problems import BrokenOffError, MissingExtraError, UnreadableError

__all__ = [
    "FORMATS",
    "SUFFIXES",
    "BrokenOffError",
    "Dialect",
    "MissingExtraError",
    "UnreadableError",
    "format_of",
    "read_contents",
    "writer_of",
]
