import json
from datetime import UTC, datetime, timedelta, timezone

import numpy as np

from uictest.core.recording import Recording, read_parquet
from uictest.judging.evaluation import results_of
from uictest.report import RunContent, RunManifest
from uictest.report.run_folder import run_name, write_recording, write_reports

from .builders import make_result


def test_a_run_is_named_after_its_start_in_utc_and_its_manifest():
    started = datetime(2026, 3, 1, 1, 30, 5, tzinfo=timezone(timedelta(hours=9)))
    name = run_name(started, RunManifest(seed=1))
    assert name.startswith("20260228T163005Z-")
    assert name == run_name(started.astimezone(UTC), RunManifest(seed=1))
    assert name != run_name(started, RunManifest(seed=2))


def test_every_format_is_written_and_results_read_back(tmp_path):
    results = [make_result(), make_result(id="other", outcome="fail")]
    text = write_reports(tmp_path, RunContent("a-run", results))
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "criteria.csv",
        "junit.xml",
        "manifest.json",
        "results.json",
        "summary.csv",
        "wheelsets.csv",
    ]
    assert (tmp_path / "results.json").read_text() == text
    document = json.loads(text)
    assert document["schema"] == "uictest/result/2"
    assert (document["manifest"]["seed"], document["complete"]) == (None, True)
    assert [result.id for result in results_of(document)] == ["dry-120[command=90]", "other"]


def test_no_clock_and_no_number_that_is_none_enters_results(tmp_path):
    texts = [
        write_reports(tmp_path, RunContent("a-run", [make_result(duration=duration)]))
        for duration in (0.1, 9.9)
    ]
    assert texts[0] == texts[1]
    assert json.loads(texts[0])["cases"][0]["measures"]["initial_adhesion_g"] is None


def test_a_file_name_that_is_no_utf_8_is_written_as_an_escape(tmp_path):
    text = write_reports(tmp_path, RunContent("a-run", [make_result(scenario="a\udcff.yaml")]))
    assert json.loads(text)["cases"][0]["scenario"] == "a\udcff.yaml"


def test_a_recording_is_found_under_the_id_of_its_case(tmp_path):
    recording = Recording({"time": np.array([0.0, 0.1])}, {"time": "s"}, {"case": "dry"})
    path = write_recording(tmp_path, "dry[command=90]", recording)
    assert path == tmp_path / "recordings" / "dry[command=90].parquet"
    assert read_parquet(path).metadata["case"] == "dry"
