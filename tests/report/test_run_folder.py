"""The folder of a run: what is written is read back, and what is damaged is refused by name."""

import json
from datetime import UTC, datetime, timedelta, timezone

import pytest

from uictest import report, runs
from uictest.core.document import Table
from uictest.core.envelope import MANIFEST
from uictest.core.recording import read_parquet
from uictest.judging import series
from uictest.judging.evaluation import cases_document
from uictest.report import CaseDescription, RunManifest, publication_of_run, publish, read_run
from uictest.report.content import Campaign, CampaignColumn, CampaignTable, manifest_digest, run_manifest
from uictest.report.difference import BaselineComparison, Difference
from uictest.report.run_folder import (
    recording_path,
    run_name,
    run_texts,
    with_recorded_traces,
    write_controller_log,
    write_recording,
)

from .builders import make_content, make_recording, make_result
from .made_up_series import make_series


def write(folder, content):
    publish(publication_of_run(content, run_texts(content)), (), folder)
    return folder / "results.json"


def full_content():
    """A run of which every document holds something."""
    outside = Difference("lost", "outcome", "pass", "none", within=False, remark="no such case")
    number = Difference("lost", "braking_distance_m", float("nan"), 1.0, False, "m", 0.5, 0.1)
    differences = {"lost": [outside, number]}
    baseline = BaselineComparison("base", "00", 5, 1, differences, {"lost": "a.yaml"}, notes=("x",))
    columns = CampaignColumn("stops", "stops"), CampaignColumn("a_m", "a", 1)
    table = CampaignTable("friction", "Friction", "12 stops", "first", columns, (("1, 2", float("nan")),))
    # The name of a file that is no UTF-8 holds lone surrogates.
    return make_content(
        make_result(scenario="b\udcff"),
        manifest=RunManifest(seed=3, inputs={"a\udcff.yaml": "00"}),
        complete=False,
        subjects={"dry-120[command=90]": CaseDescription("A title", ("a",), {"rail": "dry"})},
        baseline=baseline,
        series=[make_series(requirements=("BR-9",), test_case="WSP-TC-7")],
        passed_over=["stop 3: no brake"],
        campaign=Campaign(("All alike.",), (table,)),
    )


def test_a_run_comes_back_from_its_folder(tmp_path):
    written = full_content()
    write(tmp_path, written)
    read = read_run(tmp_path)
    assert read.name == tmp_path.name
    assert run_texts(read) == run_texts(written)
    assert cases_document(read.results) == cases_document(written.results)
    assert series.series_document(read.series) == series.series_document(written.series)
    assert (read.manifest, read.complete, read.subjects) == (written.manifest, False, written.subjects)
    assert (read.passed_over, read.campaign) == (["stop 3: no brake"], written.campaign)
    outcome, number = read.baseline.all_differences
    assert outcome == written.baseline.all_differences[0]
    assert (str(number.first), number.second, number.deviation) == ("nan", 1.0, 0.5)
    assert not read.baseline.agrees
    assert read.subject("another") == CaseDescription()


def test_recordings_and_logs_are_found_under_the_id_of_their_case(tmp_path):
    for case_id in ("slip-120[friction=0.10,command=90]", "my.train run (2)", "..a"):
        assert recording_path(tmp_path, case_id) == tmp_path / "recordings" / f"{case_id}.parquet"
    result = make_result()
    write(tmp_path, make_content(result))
    path = write_recording(tmp_path, result.id, make_recording())
    assert path == recording_path(tmp_path, result.id)
    assert read_parquet(path).metadata["case"] == "dry-120"
    assert read_run(tmp_path).traces == {}
    assert list(with_recorded_traces(read_run(tmp_path), tmp_path).traces) == [result.id]
    assert (tmp_path / write_controller_log(tmp_path, "a", "hello")).read_text() == "hello"


def test_no_clock_and_no_number_that_is_none_enters_results(tmp_path):
    texts = [run_texts(make_content(make_result(duration=duration))) for duration in (0.1, 9.9)]
    assert texts[0] == texts[1]
    document = json.loads(texts[0]["results.json"])
    assert (document["schema"], document["complete"]) == ("uictest/result/2", True)
    assert document["cases"][0]["measures"]["initial_adhesion_g"] is None


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "Expecting value"),
        ("[]", "expected a JSON object, found list"),
        ("{}", "found no schema"),
        ('{"schema": "uictest/result/1"}', "written by uictest 0.2 or older: run it again"),
        ('{"schema": "uictest/result/2", "kind": "run", "parts": {}}', "no 'cases'"),
        ('{"schema": "other"}', "found schema 'other'"),
        ("[" * 200_000, "maximum recursion depth"),
    ],
)
def test_what_is_no_run_is_rejected_with_its_file(tmp_path, text, reason):
    (tmp_path / "results.json").write_text(text)
    with pytest.raises(ValueError, match=rf"results\.json: not the results of a run: .*{reason}"):
        read_run(tmp_path)


ESTIMATE = ("series", "series", 0, "criteria", 0, "estimate", "stops")
NO_NAMES = ("../escaped", "/etc/passwd", "a/b", "..", "", ".", r"..\escaped", r"C:\a", "C:a", "a\0b")


@pytest.mark.parametrize(
    ("place", "value", "reason"),
    [
        (("complete",), "no", "'complete' must be true or false, found 'no'"),
        (("subjects",), {"a": {"title": 1}}, "not the subject of a case: subjects"),
        (("subjects",), {"a": {"title": "", "tags": []}}, "'settings' is missing"),
        (("passed_over",), [1], "'passed_over' must be a list of sentences"),
        (("manifest",), {}, "manifest: expected schema .* found no schema"),
        (("manifest", "schema"), "uictest/manifest/1", "written by uictest 0.2"),
        (("manifest", "schema"), "uictest/manifest/9", f"expected schema '{MANIFEST}', kind 'run'"),
        (("manifest", "kind"), "sweep", "found schema 'uictest/manifest/2', kind 'sweep'"),
        (("manifest", "seed"), "three", r"manifest\.seed"),
        (ESTIMATE, "many", "series.0.criteria.0.estimate.stops"),
        (("baseline", "differences", 0, "within"), "x", r"baseline.*within"),
        (("baseline", "compared"), "x", r"baseline.*compared"),
        (("baseline",), "x", "baseline"),
        (("campaign", "tables", 0, "rows"), [["1"]], "a row has not one cell for each column"),
        (("campaign", "tables", 0, "columns", 1, 2), 99, "digits of a column must be 0 to 15"),
        *((("cases", 0, "id"), case_id, "is not the name of a file") for case_id in NO_NAMES),
    ],
)
def test_what_is_damaged_is_named(tmp_path, place, value, reason):
    path = write(tmp_path, full_content())
    document = json.loads(path.read_text())
    inner = document
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    path.write_text(json.dumps(document))
    with pytest.raises(ValueError, match=rf"results\.json: .*{reason}"):
        read_run(tmp_path)


@pytest.mark.parametrize("case_id", NO_NAMES)
def test_nothing_is_written_or_looked_for_under_an_id_that_leads_elsewhere(tmp_path, case_id):
    for use in (
        lambda: recording_path(tmp_path, case_id),
        lambda: write_recording(tmp_path, case_id, make_recording(2)),
        lambda: write_controller_log(tmp_path, case_id, ""),
    ):
        with pytest.raises(ValueError, match="is not the name of a file"):
            use()


def test_a_run_is_named_after_its_start_in_utc_and_the_digest_of_its_manifest():
    started = datetime(2026, 3, 1, 1, 30, 5, tzinfo=timezone(timedelta(hours=9)))
    first = RunManifest(inputs={"a": "1", "b": "2"})
    name = run_name(started, first)
    assert name == f"20260228T163005Z-{manifest_digest(first)}"
    assert name == run_name(started.astimezone(UTC), first)
    assert len(manifest_digest(first)) == 8
    # The digest follows the content, and no order.
    assert manifest_digest(RunManifest(inputs={"b": "2", "a": "1"})) == manifest_digest(first)
    for other in (RunManifest(inputs={"a": "1"}), RunManifest(inputs=first.inputs, seed=2)):
        assert manifest_digest(other) != manifest_digest(first)


def test_a_manifest_names_versions_and_no_folder_of_the_machine(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    command = f"run {tmp_path}/scenarios -k dry -o /elsewhere/out --output=/elsewhere/out"
    manifest = run_manifest(command.split(), 7, {str(tmp_path / "a.yaml"): "00", "library:x": "11"}, cases=3)
    assert " ".join(manifest.command) == "uictest run scenarios -k dry -o .../out --output=.../out"
    assert manifest.inputs == {"a.yaml": "00", "library:x": "11"}
    assert (manifest.seed, manifest.cases) == (7, 3)
    assert {"uictest", "python", "numpy", "pydantic"} <= manifest.versions.keys()
    assert all(manifest.versions.values())


def test_what_stops_of_a_log_show_together_is_tables_whose_first_columns_stay_longest():
    campaign = full_content().campaign
    (table,) = campaign.at("first")
    assert campaign.at("detail") == []
    assert (table.name, table.file) == ("campaign_friction", "tables/campaign_friction.csv")
    assert [(column.title, texts) for column, texts in table.for_people] == [("stops", ["1, 2"])]
    assert [column.rank for column in table.columns] == [0, 1]
    lines, *tables = campaign.sections
    assert (lines.sentences, len(tables)) == (("All alike.",), 1)
    assert isinstance(tables[0], Table)


def test_a_series_is_counted_apart_from_cases(tmp_path):
    content = report.RunContent("", [make_result(id="acceptance", outcome="fail")], series=[make_series()])
    runs.publish_run(content, {}, tmp_path, ("html",))
    index = (tmp_path / "index.html").read_text("utf-8")
    assert "1 case: 1 fail; 1 series: 1 pass" in index
