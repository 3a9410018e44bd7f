"""Repeats in a scenario file, and what is said of wrong ones."""

from pathlib import Path

import pytest

from uictest.plans.scenario import ScenarioErrors, ShareOfStops, load

HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 80 km/h\n"


def read(tmp_path: Path, text: str, *overrides: str):
    path = tmp_path / "stop.yaml"
    path.write_text(HEAD + text, "utf-8")
    (case,) = load([path], overrides)
    return case.scenario


def test_one_stop_unless_the_file_says_more(tmp_path: Path) -> None:
    assert read(tmp_path, "").repeat == 1
    assert read(tmp_path, "").outcome_of_repeats == "all"
    assert read(tmp_path, "repeat: 10\noutcome_of_repeats: median").outcome_of_repeats == "median"
    assert read(tmp_path, "repeat: 10", "repeat=3").repeat == 3


def test_a_share_of_the_stops(tmp_path: Path) -> None:
    share = read(tmp_path, "repeat: 10\noutcome_of_repeats: {at_least: 90 %}").outcome_of_repeats
    assert isinstance(share, ShareOfStops)
    assert share.at_least == pytest.approx(0.9)


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("repeat: 0", "repeat: 0 is out of range: it must be at least 1", ""),
        ("repeat: 1001", "repeat: 1001 is out of range: it must be at most 1000", ""),
        ("repeat: 2.5", "repeat: expected a whole number, found a number ('2.5')", ""),
        (
            "outcome_of_repeats: 90 %",
            "outcome_of_repeats: unknown value '90 %', expected one of all, median",
            "write {at_least: 90 %} for a share of the stops",
        ),
        (
            "outcome_of_repeats: {at_least: 0.9}",
            "outcome_of_repeats.at_least: '0.9' has no unit",
            "write `90 %` (a bare 0.9 is ambiguous)",
        ),
        (
            "outcome_of_repeats: {at_least: 0 %}",
            "outcome_of_repeats.at_least: 0 % is out of range: it must be above 0 %",
            "accepted: above 0 % and at most 100 %",
        ),
        (
            "seed: 4294967290\nrepeat: 10",
            "repeat: 10 stops from seed 4294967290 end with seed 4294967299; the largest is 4294967295",
            "take a seed of at most 4294967286",
        ),
    ],
)
def test_what_is_wrong_is_said(tmp_path: Path, text: str, message: str, hint: str) -> None:
    with pytest.raises(ScenarioErrors) as raised:
        read(tmp_path, text)
    (diagnostic,) = raised.value.diagnostics
    shown = str(diagnostic)
    assert message in shown
    assert hint in shown


def test_the_last_seed_may_be_the_largest(tmp_path: Path) -> None:
    assert read(tmp_path, "seed: 4294967286\nrepeat: 10").repeat == 10
