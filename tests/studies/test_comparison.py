from __future__ import annotations

import json
from dataclasses import replace

import pytest

from uictest.studies import StudyQuantity, StudyResult, document, lines, study_table
from uictest.studies.comparison import band_text, comparison_table, ours_text, paper_text


def test_lines_have_the_papers_value_ours_and_the_band(made_up: StudyResult) -> None:
    assert lines(made_up) == [
        "made-up: A made-up study",
        "  The data of the paper's figures and tables are not public; its text says: 17.6 s.",
        "  holds   braking time: paper 17.6 s; ours 18.1 (17.9 .. 18.3) s; band 16.5 .. 19 s (ours)",
        "  misses  [bold]share: paper below 2 %; ours 2.00 %; band < 2 % (paper)",
        "  shown   actuations: paper not public; ours - (- .. -)",
        "  Made up.",
    ]


@pytest.mark.parametrize(
    ("quantity", "text"),
    [
        (StudyQuantity("a", "a", "%", upper=8.0), "<= 8 %"),
        (StudyQuantity("a", "a", lower=9.0), ">= 9"),
        (StudyQuantity("a", "a", "m"), "-"),
    ],
)
def test_bands_in_words(quantity: StudyQuantity, text: str) -> None:
    assert band_text(quantity) == text


def test_a_study_of_ours_claims_nothing_of_the_paper(made_up: StudyResult) -> None:
    assert "Our own study" in paper_text(replace(made_up.study, paper=""))


def test_the_document_holds_no_number_that_json_lacks(made_up: StudyResult) -> None:
    (study,) = json.loads(document([made_up]))["studies"]
    assert study["verdict"] == "misses"
    assert [each["verdict"] for each in study["quantities"]] == ["holds", "misses", "shown"]
    assert study["quantities"][2]["value"] is None
    assert study["quantities"][1]["upper_excluded"]


def test_the_table_shows_texts_as_they_are(made_up: StudyResult) -> None:
    from rich.console import Console

    console = Console(width=120)
    with console.capture() as capture:
        console.print(study_table(made_up))
    shown = capture.get()
    assert "[bold]share" in shown
    assert ours_text(made_up.comparisons[0]) in shown


def test_every_comparison_is_a_row(made_up: StudyResult) -> None:
    table = comparison_table([made_up, made_up])
    assert {len(column) for column in table.values()} == {6}
