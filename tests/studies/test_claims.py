"""What the values of studies are worth, against what was calibrated, searched for and stated by the paper."""

import re
from pathlib import Path

import pytest

from studies.comparison import claims, misses
from studies.quantity import NOT_ASKED, NOT_PUBLIC, SourceBand
from studies.study import STUDIES

REPOSITORY = Path(__file__).parents[2]
STUDIES_PAGE = (REPOSITORY / "docs" / "studies.md").read_text("utf-8")
TARGETS = {
    "slide-test": {"braking_time", "braking_distance", "maximum_slide"},
    "valve-actuations": {"caliper", "none", "full", "reference"},
    "appendix-b": {"braking_distance", "off_the_middle", "initial_adhesion", "minimum_slide"},
}
"""What calibration/objective.py asks for."""
LIMITS = {
    "braking_distance": (440.0, 490.0),
    "initial_adhesion": (None, 0.08),
    "after_full": (None, 2.0),
    "module_1": (None, 8.0),
    "full": (None, 8.0),
    **{f"pressure_error_{each}": (None, 2.0) for each in ("median_full", "worst_full", "worst_cylinder")},
    **{f"force_error_{each}_full": (None, 8.0) for each in ("median", "worst")},
}
"""Limits that the text of the paper states for its own method and test."""
FIGURES = ("braking_time", "braking_distance", "minimum_deceleration", "maximum_deceleration")
"""Of the real train."""
QUANTITIES = [(name, quantity) for name, study in STUDIES.items() for quantity in study.quantities]


def test_what_was_a_target_of_the_calibration_or_is_the_best_of_a_search_is_called_so():
    found = {(name, quantity.key): quantity.status for name, quantity in QUANTITIES}
    for study, keys in TARGETS.items():
        assert {found[study, key] for key in keys} == {"calibrated"}
    assert {found["field-against-rig", key] for key in FIGURES} == {"selected"}


def test_a_band_of_the_paper_has_the_papers_limits_and_its_words():
    source = [quantity for _, quantity in QUANTITIES if isinstance(quantity.band, SourceBand)]
    assert {quantity.key for quantity in source} >= set(LIMITS)
    for quantity in source:
        assert quantity.paper not in (NOT_ASKED, NOT_PUBLIC)
        if quantity.key in LIMITS and quantity.band is not None:
            assert (quantity.band.lower, quantity.band.upper) == LIMITS[quantity.key]


def test_only_what_nothing_was_fitted_to_is_declared_missed():
    """A target that is missed is a calibration that failed; a filter fitted to its own stop has no target."""
    declared = [quantity for _, quantity in QUANTITIES if quantity.declared_miss]
    assert [each.key for each in declared if each.status != "predicted"] == ["after_in_sample"]
    assert len(declared) > 1


@pytest.mark.slow
def test_the_pages_show_what_the_program_finds(result):
    """To the digit: console blocks are otherwise compared without their numbers."""
    results = [result(name) for name in STUDIES]
    counts = [line.rstrip() for line in claims(results)]
    assert counts_of_readme() == counts
    assert not_on_the_page(misses(results)[1:]) == []
    assert f"{len(misses(results)) - 1} of {total(counts)} values miss" in STUDIES_PAGE


def test_the_numbers_of_the_pages_agree_and_a_miss_that_the_page_does_not_name_is_found():
    assert f"{counts_of_readme()[-1].split()[2]} of {total(counts_of_readme())} values miss" in STUDIES_PAGE
    row = "rail-laws  distance of stop 6  < 1  {} (1.13 .. 1.15)  predicted  misses, declared".format
    assert not_on_the_page([row("1.15"), row("1.16")]) == [row("1.16")]


def not_on_the_page(missed):
    """Rows of `./reproduce -q` whose value stands in no paragraph of docs/studies.md that names the study."""
    values = [(row, re.split(r"  +", row)) for row in missed]
    return [row for row, cells in values if cells[3].split()[0] not in numbers_beside(cells[0])]


def numbers_beside(study):
    """The numbers of the sections and list items of the page that begin with the name of a study."""
    parts = re.split(r"\n(?=- `)|\n## ", STUDIES_PAGE)
    beside = "\n".join(part for part in parts if f"`{study}`" in part[:120])
    return set(re.findall(r"\d+(?:\.\d+)?", beside))


def counts_of_readme():
    text = (REPOSITORY / "README.md").read_text("utf-8")
    block = re.search(r"^\$ ./reproduce -q \| tail -6\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return block[1].splitlines()


def total(counts):
    return sum(int(number) for number in counts[-1].split()[1:])
