from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from uictest.core.measures import (
    STOP_MEASURES,
    WHEELSET_MEASURES,
    MeasureDefinition,
    Replay,
    note_samples,
    place_of,
    samples_of,
)
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


def _noted_in_python(replay):
    """Let the samples pass one by one in plain Python, and note every number after each."""
    noted = np.empty((len(replay.samples.train) - 1, len(CELLS)))
    places = np.array([place_of(cell) for cell in CELLS])
    note_samples(
        *(replay.train, replay.wheelsets, replay.definition),
        *(*replay.samples, replay.numbers, places, noted),
    )
    return noted


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
    assert noted.tobytes() == _noted_in_python(plain).tobytes()
    assert len(noted) == len(recording["time"]) - 1
    assert compiled.numbers.tobytes() == plain.numbers.tobytes()
    assert compiled.numbers_at(CELLS) == pytest.approx(noted[-1], rel=0.0, nan_ok=True)


def test_samples_from_the_end_on_are_not_fed(slipping):
    recording, definition = slipping
    samples = samples_of(recording.channels)
    cut = samples_of({name: values[:400] for name, values in recording.channels.items()})
    ended, short = Replay(samples, definition, 3.8e5, recording["time"][400]), Replay(cut, definition, 3.8e5)
    for each in (ended, short):
        pass_samples(each)
    assert ended.numbers.tobytes() == short.numbers.tobytes()


def test_a_gap_leaves_the_largest_slide_and_ends_a_lock(slipping):
    recording, definition = slipping
    whole, gap = (_replay(recording, definition, with_faults=False) for _ in range(2))
    pass_samples(whole)
    deepest = int(np.nanargmax(1.0 - recording["wheel_speed_1"][:-50] / recording["speed"][:-50]))
    channel = recording["wheel_speed_1"].copy()
    channel[deepest + 20 : deepest + 40] = np.nan
    gap = _replay(
        replace(recording, channels={**recording.channels, "wheel_speed_1": channel}),
        definition,
        with_faults=False,
    )
    pass_samples(gap)
    assert gap.wheelsets[0].maximum_slide == whole.wheelsets[0].maximum_slide
