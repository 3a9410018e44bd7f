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
    index_of,
    note_samples,
    samples_of,
)
from uictest.core.record import fields_of
from uictest.plans.scenario import load
from uictest.recorded.field_data import stated_case
from uictest.rig import RecordedRail, noted_numbers, pass_samples, simulate

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
    path = Path(__file__).parents[2] / "examples" / "faults" / "slip-120-with-fault.yaml"
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
    indices = np.array([index_of(cell) for cell in CELLS])
    note_samples(
        *(replay.train, replay.wheelsets, replay.definition),
        *(*replay.samples, replay.numbers, indices, noted),
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
    deepest = int(np.nanargmax(1.0 - recording["wheel_speed_1"][:-50] / recording["speed"][:-50]))
    channel = recording["wheel_speed_1"].copy()
    channel[deepest + 20 : deepest + 40] = np.nan
    gapped = replace(recording, channels={**recording.channels, "wheel_speed_1": channel})
    whole, gap = (_replay(each, definition, with_faults=False) for each in (recording, gapped))
    pass_samples(whole)
    pass_samples(gap)
    assert gap.wheelsets[0].maximum_slide == whole.wheelsets[0].maximum_slide


_CLEANING = "{energy: 8000 J/m, recovered_friction: 0.22, reach: 0.5 m, carry_over: 0.7}"


@pytest.mark.parametrize("wsp", ["active", "bypassed"])
def test_exact_records_give_the_shares_of_the_rig(wsp):
    """Slips averaged over a cycle, in a law that is not linear: the shares differ by 2 % of a clean rail."""
    settings = ["rail.condition=wet", "rail.friction=0.07", f"rail.cleaning={_CLEANING}", f"rig.wsp={wsp}"]
    case = stated_case("stop", 80.0 / 3.6, settings)
    recording = simulate(case, record_every=0.01).recording
    moving = np.asarray(recording["speed"]) > 0.5

    def channel(name):
        return np.array([np.asarray(recording[f"{name}_{n}"])[moving] for n in (1, 2, 3, 4)])

    time, speed = (np.asarray(recording[name])[moving] for name in ("time", "speed"))
    vehicle = case.scenario.vehicle
    base, pivots = 2.0 * vehicle.bogie.half_wheelbase, 2.0 * vehicle.half_pivot_distance
    place = np.asarray(recording["distance"])[moving] - np.array([[0.0], [base], [pivots], [pivots + base]])
    slip = speed - channel("wheel_speed")
    rail = RecordedRail(case.scenario, time, speed, place, channel("wheel_load"), slip)
    friction, share = rail.met(np.full(place.shape, 0.07))
    np.testing.assert_allclose(friction, 0.07 + share * 0.15, rtol=1e-12)
    recorded = channel("cleaned_share")
    assert recorded.max() > 0.3
    # A row of the recording shows what was computed at the beginning of its cycle.
    difference = share[:, :-1] - recorded[:, 1:]
    assert np.abs(difference).max() < 0.03
    assert np.abs(difference).mean() < 0.003


def steady_slide(seconds, slip, *cleaning, rail="wet-cleaning"):
    """The rail under a train at 20 m/s, and ones for each wheelset and sample."""
    settings = [f"rail.condition={rail}", *(f"rail.condition.cleaning.{each}" for each in cleaning)]
    case = stated_case("stop", 20.0, settings)
    time = np.arange(0.0, seconds, 0.01)
    place = 20.0 * time - np.array([[0.0], [2.5], [17.5], [20.0]])
    full = np.ones_like(place)
    return RecordedRail(case.scenario, time, 20.0 * full[0], place, 5.5e4 * full, slip * full), full


@pytest.mark.parametrize(("energy", "share"), [(60, 0.393469), (120, 0.221199)])
def test_what_earlier_stops_spent_has_cleaned_the_rail(energy, share):
    """1 - exp(-30 / 60), 1 - exp(-30 / 120): under every wheelset from the first sample on."""
    cleaning = ("spent=30 kJ/m", f"energy={energy} kJ/m", "recovered_friction=0.28")
    rail, full = steady_slide(2.0, 0.0, *cleaning, rail="leaf-layer")
    friction, found = rail.met(0.05 * full)
    np.testing.assert_allclose(found, share, atol=1e-6)
    np.testing.assert_allclose(friction, 0.05 + share * 0.23, atol=1e-6)


def test_a_constant_slide_settles_at_the_share_of_its_loss_and_nothing_that_rolls_cleans():
    rail, full = steady_slide(2.0, 0.0)
    friction, share = rail.met(0.1 * full)
    np.testing.assert_array_equal(friction, 0.1)
    np.testing.assert_array_equal(share, 0.0)
    # 1 - exp(-W / Wc), with W = F s per metre, for the first wheelset and for those behind it.
    cleaning = ("energy=5000 J/m", "recovered_friction=0.1")
    rail, full = steady_slide(5.0, 2.0, *cleaning)
    # The rail is as good as a clean one, so that the friction stays as it is: the loss is the creep law's.
    _, share = rail.met(0.1 * full)
    own = share[0, -1]
    loss = -5000.0 * np.log1p(-own)
    limit = 2.0 * 5.5e4 * 0.1 * (0.6 * np.exp(-0.2 * 2.0) + 0.4) * 0.1
    assert 0.8 * limit < loss < limit
    behind = 1.0 - (1.0 - own) * (1.0 - 0.5 * own)
    assert share[1, -1] == pytest.approx(behind, rel=1e-9)
