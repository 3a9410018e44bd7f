"""What the catalogue promises: every row that the studies must show, each with its band."""

import re

import pytest

from studies import experiments
from studies.study import STUDIES, find_studies

BANDS = {
    ("cylinder-dynamics", "before"): (4.0, 8.0),
    ("cylinder-dynamics", "after_full"): (None, 2.0),
    ("cylinder-dynamics", "after_thermal"): (None, 2.0),
    ("cylinder-dynamics", "ratio"): (None, 0.29),
    ("force-accuracy", "module_1"): (None, 8.0),
    ("force-accuracy", "full"): (None, 8.0),
    ("force-accuracy", "thermal"): (None, 8.0),
    ("bench-loops", "loop_width"): (0.45, 0.55),
    ("valve-actuations", "caliper"): (10.0, 12.0),
    ("valve-actuations", "none"): (19.0, 23.0),
    ("valve-actuations", "full"): (10.0, 12.0),
    ("slide-test", "braking_time"): (16.5, 19.0),
    ("slide-test", "braking_distance"): (185.0, 215.0),
    ("appendix-b", "braking_distance"): (440.0, 490.0),
    ("appendix-b", "initial_adhesion"): (None, 0.08),
    ("appendix-b", "minimum_slide"): (35.0, None),
}
"""Of the tool's specification; where the paper gives a figure, about that."""


def _quantities(name):
    return {quantity.key: quantity for quantity in STUDIES[name].quantities}


@pytest.mark.parametrize(("study", "key"), list(BANDS))
def test_every_band_is_the_one_that_was_set(study, key):
    band = _quantities(study)[key].band
    assert band is not None
    assert (band.lower, band.upper) == BANDS[study, key]


@pytest.mark.parametrize("study", list(STUDIES))
def test_names_keys_and_bands_of_a_study_are_sound(study):
    """Keys are unique, bands have a source, names serve as folders, titles name no figure of the paper."""
    quantities = STUDIES[study].quantities
    assert len(_quantities(study)) == len(quantities)
    bands = [quantity.band for quantity in quantities if quantity.band is not None]
    assert all(band.reason and (band.lower, band.upper) != (None, None) for band in bands)
    assert re.fullmatch(r"[a-z][a-z0-9-]*", study)
    assert not re.search(r"\b(fig|figure|table)\b", STUDIES[study].title, re.IGNORECASE)


def test_studies_are_listed_in_the_order_of_the_paper_then_ours():
    positions = [study.position for study in STUDIES.values()]
    assert positions == sorted(set(positions))
    assert next(iter(STUDIES)) == "bench-loops"
    assert list(STUDIES)[-1] == "field-against-rig"


def test_a_new_study_is_one_module(tmp_path, monkeypatch):
    text = "from studies.study import Study\nSTUDY = Study('new', 'New', '', (), None, position=15)\n"
    (tmp_path / "new_study.py").write_text(text)
    monkeypatch.setattr(experiments, "__path__", [*experiments.__path__, str(tmp_path)])
    names = list(find_studies())
    assert names[:3] == ["bench-loops", "new", "four-phase-lines"]
    assert len(names) == len(STUDIES) + 1
