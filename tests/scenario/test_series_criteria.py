"""Criteria of series, and bounds that refer to the dry stop: what may be said, and what is refused how."""

import pytest

PROFILE = """criteria:
  name: own
  criteria:
    - id: one
      layer: {layer}
      {text}
"""
DISTANCE = "measure: braking_distance\n"
LOCK = "measure: longest_lock\nwheelsets: all\n"
SERIES = "scope: series\nmeasure: "


def written(text, layer="requirement"):
    return PROFILE.format(layer=layer, text=text.replace("\n", "\n      "))


@pytest.fixture
def criterion(loaded, head):
    def read(text):
        (case,) = loaded(head + written(text))
        return case.scenario.criteria[0].criteria[0]

    return read


@pytest.mark.parametrize(
    ("text", "share"),
    [
        ("125 % of the dry stop", 1.25),
        ("  1250 permille of the  dry stop ", 1.25),
        ("'90 % of the dry stop'", 0.9),
        ("{value: 125 % of the dry stop, source: scenario}", 1.25),
    ],
)
def test_a_bound_is_a_share_of_the_dry_stop(criterion, text, share):
    read = criterion(f"measure: braking_distance\nupper: {text}")
    assert read.upper == pytest.approx(share)
    assert read.of_dry_stop
    assert read.needs_series
    assert read.unit == "%"


def test_a_criterion_of_a_series_has_the_unit_of_its_measure(criterion):
    read = criterion("scope: series\nmeasure: worst_contact_energy\nupper: 1.5 MJ")
    assert (read.unit, read.upper, read.needs_series) == ("kJ", 1.5e6, True)


def test_a_criterion_of_stops_needs_no_series(criterion):
    assert not criterion("measure: braking_distance\nupper: 600 m").needs_series


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        (DISTANCE + "upper: 125 of the dry stop", "'125' has no unit", "`125 %`"),
        (DISTANCE + "upper: 125 % of dry", "is no share of the dry stop", "`125 % of the dry stop`"),
        (DISTANCE + "upper: 125 m of the dry stop", "unknown unit 'm'", "%"),
        (DISTANCE + "upper: 0 % of the dry stop", "not above zero", "125 %"),
        (DISTANCE + "lower: 400 m\nupper: 9 % of the dry stop", "'lower' is no share", "write two criteria"),
        (LOCK + "upper: 125 % of the dry stop", "'longest_lock' has no value of", "braking_distance"),
        (SERIES + "passing_share\nlower: 90 % of the dry stop", "has no value", "median_braking_distance"),
        ("measure: k_wet\nlower: 0.8", "'k_wet' is a measure of a series", "scope: series"),
        (SERIES + "braking_distance\nupper: 500 m", "is a measure of a stop", "scope: stop"),
        (SERIES + "k_wett\nlower: 0.8", "unknown measure 'k_wett'", "'k_wet'"),
        (SERIES + "k_wet\nlower: 0.8\nwheelsets: all", "belongs to a criterion of stops", "leave it out"),
        ("scope: train\nmeasure: k_wet\nlower: 0.8", "expected one of stop, series", ""),
    ],
)
def test_what_makes_no_sense_is_refused_at_its_place(refused, head, text, message, hint):
    diagnostics = refused(head + written(text))
    shown = [each for each in diagnostics if message in each.message]
    assert shown, diagnostics
    assert hint in shown[0].hint


def test_which_stops_count_cannot_depend_on_the_dry_stop(refused, head):
    text = written("measure: braking_distance\nupper: 125 % of the dry stop", layer="validity")
    (diagnostic,) = refused(head + text)
    assert "validity" in diagnostic.message
    assert diagnostic.hint == "write `layer: requirement`"
