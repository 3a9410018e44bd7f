from collections import Counter
from dataclasses import fields, replace

import pytest

from studies.field import assumptions as module
from studies.field.assumptions import CARRY_OVERS, FAMILIES, REAL_TRAIN, SHAPES, Assumptions, FieldStop
from studies.field.search import (
    VARIATIONS,
    Point,
    Trial,
    Variation,
    Varied,
    closest,
    evenly_spread,
    neighbours,
    one_at_a_time,
    plainest,
    search,
)
from studies.field.tables import notes, simplest

PLAIN = Assumptions("constant", 0.17, 0.0, "ep-disc", 0.8)
BY_NAME = {family.name: family for family in FAMILIES}


def test_families_pair_every_brake_with_both_rails_and_a_free_build_up_with_the_library_s(field_rig):
    brakes = {"ep-disc", "distributor", "build-up-free"}
    assert BY_NAME.keys() >= brakes | {f"{brake}-cleaned" for brake in brakes}
    assert all(family.cleans == family.name.endswith("-cleaned") for family in FAMILIES)
    assert all(family.cleans == ("cleaning_energy" in family.ranges) for family in FAMILIES)
    build_up = BY_NAME["build-up-free"].ranges["fill_time"]
    assert build_up.low == field_rig.build_up("ep-disc")
    assert build_up.low < field_rig.build_up("distributor") < build_up.high


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_assumptions_fill_the_ranges_of_their_family_evenly_and_the_rest_is_the_library_s(family, field_rig):
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
    for each in assumed:
        assert each.brake == family.brake
        assert (each.cleaning_energy is None) == (not family.cleans)
        if "fill_time" not in family.ranges:
            assert each.fill_time == field_rig.build_up(family.brake)
        if "pad_factor" not in family.ranges:
            assert each.pad_factor == 1.0


def test_neighbours_stay_near_and_within_the_ranges():
    family = BY_NAME["ep-disc"]
    corner = Assumptions("dry first", 0.05, 190.0, "ep-disc", 0.8, pad_factor=1.15)
    stop = FieldStop(dict(REAL_TRAIN), (0, 0, 0, 0), 0.0)
    near = list(neighbours(Trial(family, corner, stop, 0), 0.1))
    assert all(0.05 <= each.friction <= 0.065 + 1e-12 for each in near)
    assert all(174.0 - 1e-9 <= each.place <= 190.0 for each in near)
    assert all(1.12 - 1e-9 <= each.pad_factor <= 1.18 + 1e-9 for each in near)
    assert {(each.shape, each.fill_time) for each in near} == {("dry first", 0.8)}
    assert len({each.friction for each in near}) > 4


@pytest.mark.parametrize("rail", [("dry first", 0.137, 83.0), ("dry last", 0.131, 117.0)])
def test_a_train_that_the_rig_itself_made_is_found_again(rail, field_rig, monkeypatch):
    """The search knows four figures of a stop, none of which was tried."""
    truth = Assumptions(*rail, "ep-disc", 0.8)
    train = field_rig.stops([truth])[0]
    monkeypatch.setattr(module, "REAL_TRAIN", train.figures)
    trials = search(field_rig, [BY_NAME["library"]])
    found = closest(trials)
    assert truth not in [trial.assumptions for trial in trials]
    assert found.stop.misfit < 0.5
    assert found.round > 0
    assert found.assumptions.shape == truth.shape
    assert found.assumptions.friction == pytest.approx(truth.friction, abs=0.01)
    assert found.assumptions.place == pytest.approx(truth.place, abs=15.0)


def _stop(misfit):
    return FieldStop({**REAL_TRAIN, "braking_distance": 197.0 + 4.0 * misfit}, (12, 12, 11, 11), 0.4)


def test_a_variation_changes_a_field_and_says_what_it_needs_besides():
    names = {each.name for each in fields(Assumptions)}
    for variation in VARIATIONS:
        assert {variation.assumption, *variation.together} <= names
        assert len(set(variation.values)) == len(variation.values)


def test_one_assumption_that_the_rig_s_own_train_had_is_found(field_rig, monkeypatch):
    """A train with stronger pads: they make the plainest stop agree, a longer build-up does not."""
    truth = replace(plainest(field_rig), friction=0.1775, pad_factor=1.25)
    monkeypatch.setattr(module, "REAL_TRAIN", field_rig.stops([truth])[0].figures)
    pads = Variation("pads", "pad_factor", (1.1, 1.25))
    filling = Variation("build-up", "fill_time", (3.0, 4.0), unit="s")
    base, (stronger, slower) = one_at_a_time(field_rig, [pads, filling])
    assert base.stop.misfit > 1.0
    assert stronger.agreeing[-1].value == 1.25
    assert stronger.closest.stop.misfit < 0.05
    assert stronger.closest.assumptions.friction == pytest.approx(0.1775)
    assert slower.agreeing == []


def test_the_simplest_is_the_first_family_that_agrees_else_the_closest():
    library, ep_disc, *_ = FAMILIES
    misfits = ((library, 3.0), (ep_disc, 0.9), (library, 0.1))
    far, near, nearest = (Trial(family, PLAIN, _stop(misfit), 0) for family, misfit in misfits)
    assert simplest([far, near, nearest]) is near
    assert simplest([far, Trial(ep_disc, PLAIN, _stop(1.5), 0)]).stop.misfit == pytest.approx(1.5)


def test_notes_say_what_agrees_and_at_which_value():
    trial = Trial(FAMILIES[0], PLAIN, _stop(2.0), 0)
    pads = Variation("pads", "pad_factor", (1.1, 1.2, 1.3))
    base, *points = (
        Point(*at) for at in zip((1.0, *pads.values), [PLAIN] * 4, map(_stop, (2, 2, 0.9, 0.5)), strict=True)
    )
    said = list(notes([trial], [trial], base, [Varied(pads, points)]))
    assert any(FAMILIES[0].title in note and "no stop agrees" in note for note in said)
    assert "- pads: agrees at 1.2 to 1.3." in said
    said = list(notes([trial], [trial], base, [Varied(pads, points[:1])]))
    assert "- pads: never agrees; least misfit 2.00, at 1.1." in said
