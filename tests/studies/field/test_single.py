from __future__ import annotations

from dataclasses import fields, replace

import pytest

from studies.field import real_train
from studies.field.families import FAMILIES, Assumptions
from studies.field.field_rig import FieldRig
from studies.field.real_train import REAL_TRAIN, FieldStop
from studies.field.search import Trial
from studies.field.single import VARIATIONS, Point, Variation, Varied, one_at_a_time, plainest
from studies.field.tables import notes, simplest
from studies.stop_runner import StopRunner

PLAIN = Assumptions("constant", 0.17, 0.0, "ep-disc", 0.8)


@pytest.fixture(scope="session")
def field_rig(stop_runner: StopRunner) -> FieldRig:
    return FieldRig(stop_runner)


def _stop(misfit: float) -> FieldStop:
    return FieldStop({**REAL_TRAIN, "braking_distance": 197.0 + 4.0 * misfit}, (12, 12, 11, 11), 0.4)


def test_a_variation_changes_a_field_and_says_what_it_needs_besides() -> None:
    names = {each.name for each in fields(Assumptions)}
    for variation in VARIATIONS:
        assert {variation.assumption, *variation.together} <= names
        assert len(set(variation.values)) == len(variation.values)


def test_one_assumption_that_the_rig_s_own_train_had_is_found(
    field_rig: FieldRig, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A train with stronger pads: they make the plainest stop agree, a longer build-up does not."""
    truth = replace(plainest(field_rig), friction=0.1775, pad_factor=1.25)
    monkeypatch.setattr(real_train, "REAL_TRAIN", field_rig.stops([truth])[0].figures)
    pads = Variation("pads", "pad_factor", (1.1, 1.25))
    filling = Variation("build-up", "fill_time", (3.0, 4.0), unit="s")
    base, (stronger, slower) = one_at_a_time(field_rig, [pads, filling])
    assert base.stop.misfit > 1.0
    assert stronger.agreeing[-1].value == 1.25
    assert stronger.closest.stop.misfit < 0.05
    assert stronger.closest.assumptions.friction == pytest.approx(0.1775)
    assert slower.agreeing == []


def test_the_simplest_is_the_first_family_that_agrees_else_the_closest() -> None:
    library, ep_disc, *_ = FAMILIES
    far, near, nearest = (
        Trial(family, PLAIN, _stop(misfit), 0)
        for family, misfit in ((library, 3.0), (ep_disc, 0.9), (library, 0.1))
    )
    assert simplest([far, near, nearest]) is near
    assert simplest([far, Trial(ep_disc, PLAIN, _stop(1.5), 0)]).stop.misfit == pytest.approx(1.5)


def test_notes_say_what_agrees_and_at_which_value() -> None:
    trial = Trial(FAMILIES[0], PLAIN, _stop(2.0), 0)
    pads = Variation("pads", "pad_factor", (1.1, 1.2, 1.3))
    points = [
        Point(value, PLAIN, _stop(off)) for value, off in zip(pads.values, (2.0, 0.9, 0.5), strict=True)
    ]
    said = list(notes([trial], [trial], Point(1.0, PLAIN, _stop(2.0)), [Varied(pads, points)]))
    assert any(FAMILIES[0].title in note and "no stop agrees" in note for note in said)
    assert "- pads: agrees at 1.2 to 1.3." in said
    said = list(notes([trial], [trial], Point(1.0, PLAIN, _stop(2.0)), [Varied(pads, points[:1])]))
    assert "- pads: never agrees; least misfit 2.00, at 1.1." in said
