import json
from dataclasses import replace

import pytest
from rich.console import Console

from studies.comparison import (
    band_text,
    claims,
    comparison_table,
    document,
    lines,
    misses,
    ours_text,
    paper_text,
    study_table,
    tally,
)
from studies.quantity import OwnBand, SourceBand, StudyQuantity, StudyValue
from studies.stop_runner import StopRunner
from studies.study import StudyFindings, StudyResult, run_study


def test_a_band_missed_decides_and_without_a_band_nothing_does(made_up):
    assert [comparison.result for comparison in made_up.comparisons] == ["holds", "misses", "shown"]
    assert (made_up.result, made_up.fails) == ("misses", True)
    unbounded = replace(made_up.study, quantities=made_up.study.quantities[2:])
    assert StudyResult(unbounded, made_up.findings).result == "shown"


def test_a_study_must_find_all_its_quantities(made_up):
    study = replace(made_up.study, run=lambda stop_runner: StudyFindings({"time": StudyValue(18.0)}))
    with pytest.raises(KeyError, match="share, count"):
        run_study(study, StopRunner())


def test_lines_have_the_papers_value_ours_and_the_band(made_up):
    assert lines(made_up) == [
        "made-up: A made-up study",
        "  The data of the paper's figures and tables are not public; its text says: 17.6 s.",
        (
            "  holds  calibrated  braking time: paper 17.6 s; ours 18.1 (17.9 .. 18.3) s; "
            "band 16.5 .. 19 s (ours)"
        ),
        "  misses  predicted  [bold]share: paper below 2 %; ours 2.00 %; band < 2 % (paper)",
        "  shown  predicted  actuations: paper not public; ours - (- .. -)",
        "  Made up.",
    ]


@pytest.mark.parametrize(
    ("band", "text"),
    [
        (OwnBand(upper=8.0, reason="ours"), "<= 8 %"),
        (OwnBand(upper=8.0, below=True, reason="ours"), "< 8 %"),
        (OwnBand(lower=9.0, reason="ours"), ">= 9 %"),
        (OwnBand(lower=9.0, above=True, reason="ours"), "> 9 %"),
        (SourceBand(lower=0.0, upper=9.5), "0 .. 9.5 %"),
        (None, "-"),
    ],
)
def test_bands_in_words(band, text):
    assert band_text(StudyQuantity("a", "a", "%", status="predicted", band=band)) == text


def test_a_study_of_ours_claims_nothing_of_the_paper(made_up):
    assert "Our own study" in paper_text(replace(made_up.study, paper=""))


def test_document_and_table_hold_every_comparison_and_no_number_that_json_lacks(made_up):
    (study,) = json.loads(document([made_up]))["studies"]
    assert (study["result"], study["fails"]) == ("misses", True)
    assert [each["result"] for each in study["quantities"]] == ["holds", "misses", "shown"]
    assert [each["status"] for each in study["quantities"]] == ["calibrated", "predicted", "predicted"]
    assert [each["band"] and each["band"]["of"] for each in study["quantities"]] == ["ours", "source", None]
    assert study["quantities"][2]["value"] is None
    assert study["quantities"][1]["band"]["upper_excluded"]
    table = comparison_table([made_up, made_up])
    assert {len(column) for column in table.values()} == {6}
    assert table["status"][:3] == ["calibrated", "predicted", "predicted"]
    assert table["result"][:3] == ["holds", "misses", "shown"]
    assert table["band"][:3] == ["ours", "source", ""]


def test_the_table_shows_texts_as_they_are(made_up):
    console = Console(width=120)
    with console.capture() as capture:
        console.print(study_table(made_up))
    shown = capture.get()
    assert "[bold]share" in shown
    assert ours_text(made_up.comparisons[0]) in shown


def declared(made_up, value):
    """The study, the paper's band of whose share is declared missed; `value` is the share."""
    first, share, last = made_up.study.quantities
    band = SourceBand(upper=2.0, below=True, declared_miss="Heat.")
    study = replace(made_up.study, quantities=(first, replace(share, band=band), last))
    values = {**made_up.findings.values, "share": StudyValue(value)}
    return StudyResult(study, replace(made_up.findings, values=values))


def test_a_declared_miss_is_said_everywhere_and_so_is_one_that_holds(made_up):
    result = declared(made_up, 9.56)
    assert "  misses, declared  predicted  [bold]share: " in "\n".join(lines(result))
    assert "  Declared missed: [bold]share. Heat." in lines(result)
    (study,) = json.loads(document([result]))["studies"]
    assert (study["result"], study["fails"]) == ("misses", False)
    assert study["quantities"][1]["declared_miss"] == "Heat."
    assert comparison_table([result])["declared_miss"] == ["", "Heat.", ""]
    assert tally([result, made_up]) == "6 values: 2 hold, 2 miss (1 declared), 2 shown"
    assert [line.split()[-1] for line in misses([result, made_up])] == ["result", "declared", "misses"]
    result = declared(made_up, 1.9)
    assert "  holds, declared missed  predicted  [bold]share: " in "\n".join(lines(result))
    assert [line.split()[-2:] for line in misses([result])][1:] == [["declared", "missed"]]


def test_claims_are_counted_by_status_and_result(made_up):
    table = [line.split() for line in claims([made_up, declared(made_up, 9.56)])]
    assert table == [
        ["status", "holds", "misses", "shown"],
        ["calibrated", "2", "0", "0"],
        ["selected", "0", "0", "0"],
        ["by", "construction", "0", "0", "0"],
        ["predicted", "0", "2", "2"],
        ["all", "2", "2", "2"],
    ]
