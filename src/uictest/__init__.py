"""A railway brake rig in software: scenarios in, verdicts out."""

__version__ = "0.1.0"
