"""The bench of the second module: what its sensors record, under inputs of the rig's own bench and stops."""

from __future__ import annotations

import numpy as np

from studies.hardware.module import Samples, run
from studies.hardware.parameters import ATMOSPHERE, BAR, HARDWARE, Hardware
from uictest import Recording

_PRESSURE_RANGE, _PRESSURE_BITS = 10.0 * BAR, 12
_PRESSURE_NOISE = 0.0015 * BAR
"""Standard deviation of one sample of a transducer of class 0.1 behind a filter; chosen."""
_FORCE_RANGE, _FORCE_BITS, _FORCE_NOISE = 25e3, 12, 10.0
"""Loadcells of class 0.1, summed, N; chosen."""
_SENSORS = {
    "measured_pressure_2": ("tank_2", 1.001, -0.003 * BAR),
    "cylinder_pressure_1": ("cylinder", 0.9995, 0.002 * BAR),
    "brake_line_pressure": ("line", 1.0, 0.004 * BAR),
}
"""Channel -> what it reads, its gain and its offset, Pa; every sensor has an error of its own; chosen."""
TRUE = "tank_pressure_1"
"""Channel of the true pressure of the cylinder, as the bench of the rig calls it."""


def recorded(inputs: Recording, seed: int, h: Hardware = HARDWARE, refine: int = 1) -> Recording:
    """Return the record of the module's bench under the line pressure and the commands of a record.

    Nothing but these two channels of `inputs` is used: brake line and valve commands run open loop. The
    channels are those of `uictest bench` that `uictest identify` asks for, the true pressure of the cylinder
    and the stroke. `seed` is that of the sensors' noise.
    """
    time, line, commands = (inputs[name] for name in ("time", "brake_line_pressure", "valve_command_1"))
    step = float(time[-1] - time[0]) / (len(time) - 1)
    found = {**run(line, commands, step, h, refine), "line": line + ATMOSPHERE}
    draw = np.random.Generator(np.random.Philox(seed))
    channels = {"time": time, "valve_command_1": commands}
    for name, (source, gain, offset) in _SENSORS.items():
        noise = _PRESSURE_NOISE * draw.standard_normal(len(time))
        true = gain * (found[source] - ATMOSPHERE) + offset
        channels[name] = _read(true + noise, _PRESSURE_RANGE, _PRESSURE_BITS)
    noisy = found["force"] + _FORCE_NOISE * draw.standard_normal(len(time))
    channels["clamping_force_1"] = _read(noisy, _FORCE_RANGE, _FORCE_BITS)
    channels[TRUE] = found["cylinder"] - ATMOSPHERE
    channels["stroke_1"] = found["stroke"]
    units = {"time": "s", "valve_command_1": "1", "clamping_force_1": "N", "stroke_1": "m"}
    return Recording(channels, dict.fromkeys(channels, "Pa") | units, {"origin": "second module, simulated"})


def _read(true: Samples, reach: float, bits: int) -> Samples:
    """Return what a converter reads of a signal, down to 5 % of its range below zero."""
    unit = reach / 2**bits
    return np.asarray(np.clip(np.round(true / unit) * unit, -0.05 * reach, reach))
