"""The controllers of this package: every module here declares one as ``CONTROLLER``."""
