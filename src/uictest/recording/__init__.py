"""Channels with units over time, and files that appear whole or not at all."""

from uictest.recording.atomic import atomic_path, write_bytes_atomic, write_text_atomic
from uictest.recording.parquet import read_parquet, write_parquet
from uictest.recording.recording import BRAKE_COMMAND_TIME, ORIGIN, TIME, Recording

__all__ = [
    "BRAKE_COMMAND_TIME",
    "ORIGIN",
    "TIME",
    "Recording",
    "atomic_path",
    "read_parquet",
    "write_bytes_atomic",
    "write_parquet",
    "write_text_atomic",
]
