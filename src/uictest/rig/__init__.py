"""The rig: parts coupled, stepped from the brake command to standstill."""

from uictest.rig.native import is_warm
from uictest.rig.simulate import Stop, simulate

__all__ = ["Stop", "is_warm", "simulate"]
