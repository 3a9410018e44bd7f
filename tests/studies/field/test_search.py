from __future__ import annotations

from collections import Counter

import pytest

from studies.field import real_train
from studies.field.families import CARRY_OVERS, FAMILIES, SHAPES, Assumptions, Family
from studies.field.field_rig import FieldRig
from studies.field.search import Trial, closest, evenly_spread, neighbours, search
from studies.stop_runner import StopRunner

BY_NAME = {family.name: family for family in FAMILIES}


@pytest.fixture(scope="session")
def field_rig(stop_runner: StopRunner) -> FieldRig:
    return FieldRig(stop_runner)


def test_families_pair_every_brake_with_both_rails() -> None:
    brakes = {"ep-disc", "distributor", "build-up-free"}
    assert BY_NAME.keys() >= brakes | {f"{brake}-cleaned" for brake in brakes}
    assert all(family.cleans == family.name.endswith("-cleaned") for family in FAMILIES)
    assert all(family.cleans == ("cleaning_energy" in family.ranges) for family in FAMILIES)


def test_a_free_build_up_reaches_from_one_brake_of_the_library_past_the_other(field_rig: FieldRig) -> None:
    build_up = BY_NAME["build-up-free"].ranges["fill_time"]
    assert build_up.low == field_rig.build_up("ep-disc")
    assert build_up.low < field_rig.build_up("distributor") < build_up.high


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_assumptions_fill_the_ranges_of_their_family_evenly(family: Family, field_rig: FieldRig) -> None:
    assumed = list(evenly_spread(family, field_rig))
    assert len(set(assumed)) == len(assumed) == 2**family.evenly
    shapes = Counter(each.shape for each in assumed)
    assert shapes.keys() == set(SHAPES)
    assert max(shapes.values()) - min(shapes.values()) <= len(CARRY_OVERS)
    for name, each in family.ranges.items():
        values = sorted(getattr(one, name) for one in assumed)
        quarter = 0.25 * (each.high - each.low)
        counts = Counter(min(int((value - each.low) / quarter + 1e-9), 3) for value in values)
        assert set(counts.values()) == {len(assumed) // 4}


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_what_a_family_does_not_vary_is_the_library_s(family: Family, field_rig: FieldRig) -> None:
    for each in evenly_spread(family, field_rig):
        assert each.brake == family.brake
        assert (each.cleaning_energy is None) == (not family.cleans)
        if "fill_time" not in family.ranges:
            assert each.fill_time == field_rig.build_up(family.brake)
        if "pad_factor" not in family.ranges:
            assert each.pad_factor == 1.0


def test_neighbours_stay_near_and_within_the_ranges() -> None:
    family = BY_NAME["ep-disc"]
    corner = Assumptions("dry first", 0.05, 190.0, "ep-disc", 0.8, pad_factor=1.15)
    stop = real_train.FieldStop(dict(real_train.REAL_TRAIN), (0, 0, 0, 0), 0.0)
    near = list(neighbours(Trial(family, corner, stop, 0), 0.1))
    assert all(0.05 <= each.friction <= 0.065 + 1e-12 for each in near)
    assert all(174.0 - 1e-9 <= each.place <= 190.0 for each in near)
    assert all(1.12 - 1e-9 <= each.pad_factor <= 1.18 + 1e-9 for each in near)
    assert {(each.shape, each.fill_time) for each in near} == {("dry first", 0.8)}
    assert len({each.friction for each in near}) > 4


@pytest.mark.parametrize(
    ("name", "truth"),
    [
        ("library", Assumptions("dry first", 0.137, 83.0, "ep-disc", 0.8)),
        ("library", Assumptions("dry last", 0.131, 117.0, "ep-disc", 0.8)),
    ],
)
def test_a_train_that_the_rig_itself_made_is_found_again(
    name: str, truth: Assumptions, field_rig: FieldRig, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The search knows four figures of a stop, none of which was tried."""
    train = field_rig.stops([truth])[0]
    monkeypatch.setattr(real_train, "REAL_TRAIN", train.figures)
    trials = search(field_rig, [BY_NAME[name]])
    found = closest(trials)
    assert truth not in [trial.assumptions for trial in trials]
    assert found.stop.misfit < 0.5
    assert found.round > 0
    assert found.assumptions.shape == truth.shape
    assert found.assumptions.friction == pytest.approx(truth.friction, abs=0.01)
    assert found.assumptions.place == pytest.approx(truth.place, abs=15.0)
