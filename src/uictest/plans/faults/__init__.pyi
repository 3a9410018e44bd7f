from .catalogue import FAULT_KINDS as FAULT_KINDS, PARTS as PARTS
from .kind import (
    MOST_FAULTS as MOST_FAULTS,
    SPEED_SENSOR as SPEED_SENSOR,
    Effects as Effects,
    FaultKind as FaultKind,
    FaultValue as FaultValue,
)
