"""The memory through which rig and controller talk, laid out as ``uictest_controller.h`` has it."""

from typing import Final

import numpy as np

WHEELSETS: Final = 4
ABI_VERSION: Final = 1

INPUTS: Final = np.dtype(
    [
        ("cycle", "i8"),
        ("time", "f8"),
        ("wheel_speed", "f8", WHEELSETS),
        ("cylinder_pressure", "f8", WHEELSETS),
        ("brake_demand", "f8"),
        ("speed_valid", "i4", WHEELSETS),
    ]
)
"""`uictest_inputs`."""
OUTPUTS: Final = np.dtype(
    [
        ("reference_speed", "f8"),
        ("hold", "i4", WHEELSETS),
        ("vent", "i4", WHEELSETS),
        ("diagnosis", "u4"),
        ("padding", "u4"),
    ]
)
"""`uictest_outputs`."""
GUARD: Final = 0x5AFE_C0DE_5AFE_C0DE
"""Written behind the outputs: a controller that writes beyond them destroys it."""

NOT_CALLED: Final = 0
STEPPING: Final = 1
OPENING: Final = 2
CLOSING: Final = 3

NO_FAILURE: Final = 0
STEP_FAILED: Final = 1
FORBIDDEN_COMMAND: Final = 2
NO_MAGNET_STATE: Final = 3
WROTE_BEYOND: Final = 4


_OWN: Final = [(name, "i8") for name in ("guard", "calling", "failure", "failed_wheelset", "cycles")]
EXCHANGE: Final = np.dtype([*INPUTS.descr, *OUTPUTS.descr, *_OWN])
"""Inputs, outputs, then: `guard`; `calling`, what the controller is asked to do at present (STEPPING, ...);
`failure`, what was wrong with its answer (STEP_FAILED, ...); `failed_wheelset`, 0 to 3; `cycles`, how many
steps were begun."""
OUTPUTS_AT: Final = INPUTS.itemsize
"""Offset of the outputs in :data:`EXCHANGE`."""
