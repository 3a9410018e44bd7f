import shlex

import pytest

from uictest.report import DrawnInterval, Flip, SweepResult, WrittenValue
from uictest.report.sweep.sweep_sentences import (
    bar,
    circumstances_words,
    command_alone,
    flip_words,
    share_words,
    sweep_tally,
    swept_words,
)


def _counts(met, **outcomes):
    """A sweep of 75 cases, as far as counting goes."""
    empty = {"missed": (), "rates": {}, "maps": (), "measures": (), "trends": (), "worst": ()}
    rest = {"subjects": {}, "sensitivities": (), "frontier": None, "notes": (), "base": {}, "controllers": ()}
    return SweepResult(name="", title="", cases=75, met=met, outcomes=outcomes, **empty, **rest)


def test_a_sweep_is_counted_by_outcome():
    outcomes = {"pass": 70, "fail": 1, "invalid": 0, "error": 1, "skipped": 0, "inconclusive": 3}
    counts = "75 cases: 70 pass, 1 fail, 1 error, 3 inconclusive; 5 not as expected"
    assert sweep_tally(_counts(70, **outcomes)) == counts


def test_cases_that_no_criterion_applies_to_are_counted_as_skipped():
    assert (
        sweep_tally(_counts(75, **{"pass": 3, "error": 0, "skipped": 72})) == "75 cases: 3 pass, 72 skipped"
    )


@pytest.mark.parametrize(
    ("values", "shown"),
    [
        ([WrittenValue("80 %"), WrittenValue("90 %")], "80 %, 90 %"),
        ([WrittenValue(f"0.{k}") for k in (1, 2, 3, 4)], "0.1 .. 0.4 (4 values)"),
        ([WrittenValue(f"{k} %") for k in (50, 100, 200, 80)], "50 % .. 200 % (4 values)"),
        ([WrittenValue(text) for text in "badc"], "b, a, d, … (4 values)"),
        ([DrawnInterval(0.08, 0.12, "m/s"), DrawnInterval(0.12, 0.16, "m/s")], "0.08 .. 0.16 m/s, drawn"),
        ([], ""),
    ],
)
def test_what_is_swept_is_described_by_its_ends(values, shown):
    assert swept_words(values) == shown


@pytest.mark.parametrize(
    ("met", "cases", "share", "blocks"),
    [(1000, 1000, "100", 10), (999, 1000, "99", 9), (1, 1000, "1", 1), (0, 9, "0", 0)],
)
def test_only_what_is_whole_is_shown_as_whole(met, cases, share, blocks):
    assert share_words(met, cases) == share
    assert bar(met, cases).count("█") == blocks
    assert len(bar(met, cases)) == 10


def test_no_case_has_no_share():
    assert (share_words(0, 0), bar(0, 0)) == ("–", "")  # noqa: RUF001 - a dash on paper


def test_a_flip_is_described_in_its_direction():
    low, high = WrittenValue("0.10"), WrittenValue("0.11")
    assert flip_words(Flip(low, high, met_at_low=True)) == "met up to 0.10, not met from 0.11"
    assert flip_words(Flip(low, high, met_at_low=False)) == "not met up to 0.10, met from 0.11"


def test_circumstances_are_listed():
    assert circumstances_words({"a": WrittenValue("1"), "b": WrittenValue("2 m")}) == "a = 1, b = 2 m"
    assert circumstances_words({}) == "all cases"


def test_one_case_alone_runs_as_in_the_sweep_in_a_folder_of_its_own():
    manifest = {"file": "my study.sweep.yaml", "set": ["brake.command=80 %"], "seed": 3}
    words = shlex.split(command_alone(manifest))
    assert words[:3] == ["uictest", "sweep", "my study.sweep.yaml"]
    given = dict(zip(words[3::2], words[4::2], strict=True))
    assert given == {"--set": "brake.command=80 %", "--seed": "3", "-k": "CASE", "-o": "alone/CASE"}
    assert command_alone({"file": "-x y.sweep.yaml"}).startswith("uictest sweep './-x y.sweep.yaml' -k")
    assert command_alone({}) == "uictest sweep FILE -k 'CASE' -o 'alone/CASE'"
