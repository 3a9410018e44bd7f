from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES, MeasureDefinition, Replay, samples_of
from uictest.core.record import fields_of
from uictest.plans.scenario import load
from uictest.rig import noted_numbers, pass_samples, simulate

CELLS = [
    (name, number, place)
    for number, layout in enumerate((STOP_MEASURES, *[WHEELSET_MEASURES] * 4))
    for name in layout.names
    for place in (range(layout[name].shape[0]) if layout[name].shape else [None])
]
"""Every number of the records."""


@pytest.fixture(scope="module")
def slipping():
    """The stop of a case in which a speed sensor fails, and how its samples become measures."""
    path = Path(__file__).parents[3] / "examples" / "faults" / "slip-120-with-fault.yaml"
    (case,) = load([path], overrides=["brake.pad=disc-pad"])
    measures = case.scenario.measures
    definition = {name: float(getattr(measures, name)) for name in fields_of(MeasureDefinition)}
    return simulate(case, record_every=0.02).recording, SimpleNamespace(**definition)


def _replay(recording, definition, *, with_faults):
    rows = len(recording["time"])
    begun = np.arange(rows) > rows // 3
    of_one = np.tile([0.0, 0.0, 1.0, 0.0], (rows, 1)) * begun[:, None]
    faults = (begun.astype(float), of_one, of_one, of_one) if with_faults else None
    force = np.full((rows, 4), 9e3)
    return Replay(samples_of(recording.channels, force, faults), definition, 3.8e5)


@pytest.mark.parametrize("with_faults", [True, False])
@pytest.mark.parametrize("gap", ["", "wheel_speed_1", "clamping_force_2", "brake_line_pressure"])
def test_compiled_code_and_plain_python_note_the_same_bits(slipping, gap, with_faults):
    recording, definition = slipping
    if gap:
        channel = recording[gap].copy()
        channel[250:350] = np.nan
        recording = replace(recording, channels={**recording.channels, gap: channel})
    compiled, plain = (_replay(recording, definition, with_faults=with_faults) for _ in range(2))
    noted = noted_numbers(compiled, CELLS)
    assert noted.tobytes() == plain.noted(CELLS).tobytes()
    assert len(noted) == len(recording["time"]) - 1
    assert repr(compiled.train) == repr(plain.train)
    assert repr(compiled.wheelsets) == repr(plain.wheelsets)


def test_samples_from_the_end_on_are_not_fed(slipping):
    recording, definition = slipping
    time = recording["time"]
    plain, compiled = (replace(_replay(recording, definition, with_faults=True), end=time[400]) for _ in "ab")
    assert list(plain.pass_samples()) == time[1:400].tolist()
    pass_samples(compiled)
    assert repr(compiled.train) == repr(plain.train)
    assert repr(compiled.wheelsets) == repr(plain.wheelsets)
