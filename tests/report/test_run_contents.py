import json

import pytest

from uictest.judging.evaluation import cases_document
from uictest.report import (
    CaseDescription,
    RunContent,
    RunManifest,
    read_run,
    recording_path,
    with_recorded_traces,
    write_recording,
    write_reports,
)

from .builders import make_recording, make_result


def test_a_run_comes_back_from_its_folder(tmp_path):
    # The name of a file that is no UTF-8 holds lone surrogates.
    result, subject = make_result(scenario="b\udcff"), CaseDescription("A title", ("a",), {"rail": "dry"})
    manifest = RunManifest(seed=3, inputs={"a\udcff.yaml": "00"})
    written = RunContent("a-run", [result], manifest, complete=False, subjects={result.id: subject})
    write_reports(tmp_path, written)
    write_recording(tmp_path, result.id, make_recording())
    content = with_recorded_traces(read_run(tmp_path), tmp_path)
    assert cases_document(content.results) == cases_document([result])
    assert (content.name, content.manifest, content.complete) == (tmp_path.name, manifest, False)
    assert content.subject(result.id) == subject
    assert content.subject("another") == CaseDescription()
    assert list(content.traces) == [result.id]
    assert read_run(tmp_path).traces == {}


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


@pytest.mark.parametrize(
    ("written", "changed", "reason"),
    [
        ('"complete": true', '"complete": "no"', "'complete' must be true or false, found 'no'"),
        ('"subjects": {}', '"subjects": {"a": {"title": 1}}', "subject"),
    ],
)
def test_what_is_damaged_is_named(tmp_path, written, changed, reason):
    write_reports(tmp_path, RunContent("a-run", [make_result()]))
    text = (tmp_path / "results.json").read_text()
    (tmp_path / "results.json").write_text(text.replace(written, changed))
    with pytest.raises(ValueError, match=reason):
        read_run(tmp_path)


@pytest.mark.parametrize(
    "case_id", ["../escaped", "/etc/passwd", "a/b", "..", "", ".", r"..\escaped", r"C:\a", "C:a", "a\0b"]
)
def test_an_id_that_leads_out_of_the_folder_is_refused(tmp_path, case_id):
    folder = tmp_path / "run"
    folder.mkdir()
    write_reports(folder, RunContent("a-run", [make_result(id="fine")], RunManifest()))
    results = folder / "results.json"
    written = results.read_text("utf-8")
    assert '"id": "fine"' in written
    results.write_text(written.replace('"id": "fine"', f'"id": {json.dumps(case_id)}'), "utf-8")
    with pytest.raises(ValueError, match=r"results\.json.*is not the name of a file"):
        read_run(folder)
    with pytest.raises(ValueError, match="is not the name of a file"):
        write_recording(folder, case_id, make_recording())
    with pytest.raises(ValueError, match="is not the name of a file"):
        recording_path(folder, case_id)


@pytest.mark.parametrize("case_id", ["slip-120[friction=0.10,command=90]", "my.train run (2)", "..a"])
def test_ids_of_cases_and_names_of_recorded_files_are_names(tmp_path, case_id):
    assert recording_path(tmp_path, case_id) == tmp_path / "recordings" / f"{case_id}.parquet"
