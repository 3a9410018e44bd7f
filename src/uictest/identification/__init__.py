"""Hysteresis and cylinder dynamics from records, whoever made them: this room knows no rig."""

from uictest.identification.cylinder import CylinderResult, identify_cylinder, require_fit
from uictest.identification.hysteresis import HysteresisResult, identify_hysteresis
from uictest.identification.suitability import UnsuitableRecordError

__all__ = [
    "CylinderResult",
    "HysteresisResult",
    "UnsuitableRecordError",
    "identify_cylinder",
    "identify_hysteresis",
    "require_fit",
]
