"""Every band is held by the shipped library, or declared missed and missed; its figures are labelled."""

from dataclasses import replace
from functools import cache

import pytest

from studies import filter_procedures, sanded_rig, slip_brake_tests
from studies.comparison import band_text, ours_text
from studies.experiments import (
    cylinder_dynamics,
    dry_distance,
    four_phase_lines,
    rail_laws,
    sand,
    train_on_one_rail,
)
from studies.model_errors import judged_conditions
from studies.slip_brake_tests import CLEANED
from studies.study import STUDIES, run_study

QUICK = ("bench-loops", "four-phase-lines", "command-level", "slide-test", "valve-actuations", "appendix-b")
_SLOW = frozenset(
    {
        *("another-caliper", "compensation-domain", "field-against-rig"),
        *("independent-integration", "random-rail", "robustness"),
    }
)

BOUNDED = [
    pytest.param(name, quantity.key, id=f"{name}-{quantity.key}", marks=[pytest.mark.slow] * (name in _SLOW))
    for name, study in STUDIES.items()
    for quantity in study.quantities
    if quantity.band is not None
]
WORST = replace(judged_conditions(), frictions=(0.085, 0.105), seeds=(41,))
"""Of the conditions that the compensation is judged on, those under which it errs most."""
FEWER = {
    # Slower and weaker stops have no band; of those that have one, none differs by more than these.
    "dry-distance": [(dry_distance, {"SPEEDS": ("100 km/h", "120 km/h"), "COMMANDS": ("70 %", "100 %")})],
    "rail-cleaning": [(slip_brake_tests, {"ENERGIES": ("none", CLEANED), "SEEDS": range(1)})],
    "cylinder-dynamics": [
        (cylinder_dynamics, {"SEEDS": range(1)}),
        (filter_procedures, {"judged_conditions": lambda: WORST}),
    ],
    "four-phase-lines": [(four_phase_lines, {"judged_conditions": lambda: replace(WORST, wheelsets=(1,))})],
    "train": [(train_on_one_rail, {"SEEDS": range(1)})],
    "sand": [(sand, {"VARIED": ()}), (sanded_rig, {"SEEDS": range(1), "_CARS": 2})],
    "rail-laws": [(rail_laws, {"SEEDS": range(1), "SPEEDS": (60,), "FRICTIONS": (0.10,), "USED_SPEED": 80})],
}
"""Studies that are judged here on fewer of their stops; `./reproduce` judges all of them."""


@pytest.fixture(scope="module")
def judged(stop_runner):
    """Run a study on few stops, or return its earlier result."""

    @cache
    def run(name):
        with pytest.MonkeyPatch.context() as patch:
            for module, constants in FEWER.get(name, ()):
                for constant, value in constants.items():
                    patch.setattr(module, constant, value)
            return run_study(STUDIES[name], stop_runner)

    return run


@pytest.mark.parametrize(("study", "key"), BOUNDED)
def test_the_figure_is_as_claimed(study, key, judged):
    comparison = next(each for each in judged(study).comparisons if each.quantity.key == key)
    found, band = ours_text(comparison), band_text(comparison.quantity)
    assert not comparison.fails, f"{comparison.quantity.title}: {found}, band {band}"


@pytest.mark.parametrize("name", QUICK)
def test_axes_name_their_units(name, judged):
    figure_module = pytest.importorskip("matplotlib.figure")
    done = judged(name)
    assert done.study is STUDIES[name]
    for drawing in done.findings.drawings.values():
        figure = figure_module.Figure()
        drawing(figure)
        labels = {text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text}
        assert labels
        assert all(", " in label or label.startswith("%") for label in labels)
