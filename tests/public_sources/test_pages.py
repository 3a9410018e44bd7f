"""Pages and table are what the program finds, and misses are counted as such."""

import pytest

from validation.__main__ import files, find_sources, main, validate
from validation.source import Comparison, agreement


@pytest.fixture(scope="module")
def validations():
    return validate(list(find_sources().values()))


def test_every_page_and_the_table_are_up_to_date(validations):
    """`python -m validation` writes them again."""
    stale = [path.name for path, text in files(validations).items() if path.read_text("utf-8") != text]
    assert stale == []


def test_every_comparison_says_what_was_fitted_and_none_of_it_is_judged(validations):
    for each in validations:
        fitted = [comparison for comparison in each.findings.comparisons if comparison.fitted]
        assert bool(fitted) != each.source.fitted.startswith("Nothing"), each.source.name
        assert each.predicted.count + len(fitted) == len(each.findings.comparisons)


def test_sources_that_miss_come_first_and_what_misses_stands_first_on_a_page(validations):
    overview = next(text for path, text in files(validations).items() if path.stem == "README")
    rows = [line.split(" | ") for line in overview.splitlines() if line.startswith("| [")]
    assert len(rows) == len(validations)
    shares = [int(missed.strip("*")) / int(predicted) for _, _, predicted, missed, *_ in rows]
    assert shares == sorted(shares, reverse=True)
    assert shares[0] > 0.0
    for path, text in files(validations).items():
        rows = [line.rsplit(" | ", 2)[1:] for line in text.splitlines() if line.startswith("| ")][1:]
        missed = [status == "predicted" and result == "misses |" for status, result in rows]
        assert path.stem == "README" or missed == sorted(missed, reverse=True)


@pytest.mark.parametrize(
    ("source", "here", "difference", "result"),
    [
        (100.0, 104.9, 4.9, "holds"),
        (100.0, 94.9, -5.1, "misses"),
        ((2.0, 3.0), 2.5, 0.0, "holds"),
        ((2.0, 3.0), 3.03, 1.0, "misses"),
        ((5.0, 8.0), None, None, "misses"),
    ],
)
def test_a_number_holds_near_the_sources_and_a_range_only_inside(source, here, difference, result):
    comparison = Comparison("distance", "m", source, here)
    assert comparison.difference == (None if difference is None else pytest.approx(difference))
    assert comparison.result == result


def test_bias_and_spread_are_of_numbers_and_what_is_not_modelled_is_missed():
    numbers = [Comparison("a", "m", 100.0, 101.0), Comparison("b", "m", 100.0, 107.0)]
    found = agreement([*numbers, Comparison("c", "m", 100.0, None)])
    assert (found.count, found.missed, found.worst) == (3, 2, numbers[1])
    assert found.bias == pytest.approx(4.0)
    assert found.spread == pytest.approx(4.242640687)
    assert agreement([*numbers, Comparison("d", "", (1.0, 2.0), 1.5)]).bias is None


def test_a_page_is_printed_by_name_and_another_name_is_refused(capsys):
    assert main(["creep-theory"]) == 0
    assert capsys.readouterr().out.startswith("# Creep force of a clean elliptic contact")
    with pytest.raises(SystemExit):
        main(["nowhere"])
