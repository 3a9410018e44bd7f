from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from uictest.evaluation import CaseResult, cases_document
from uictest.recording import Recording
from uictest.report import CaseDescription, RunContent, RunManifest, read_run, write_recording, write_reports

MakeResult = Callable[..., CaseResult]


def test_a_run_comes_back_from_its_folder(
    tmp_path: Path, make_result: MakeResult, make_recording: Callable[..., Recording]
) -> None:
    result, subject = make_result(), CaseDescription("A title", ("a",), {"rail": "dry"})
    # The name of a file that is no UTF-8 holds lone surrogates.
    manifest = RunManifest(seed=3, inputs={"a\udcff.yaml": "00"})
    written = RunContent("a-run", [result], manifest, complete=False, subjects={result.id: subject})
    write_reports(tmp_path, written)
    write_recording(tmp_path, result.id, make_recording())
    content = read_run(tmp_path, traces=True)
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
        ("{}", "expected a result document"),
        ('{"schema": "uictest/result/1"}', "no 'cases'"),
        ('{"schema": "other"}', "found 'other'"),
        ("[" * 200_000, "maximum recursion depth"),
    ],
)
def test_what_is_no_run_is_rejected_with_its_file(tmp_path: Path, text: str, reason: str) -> None:
    (tmp_path / "results.json").write_text(text)
    with pytest.raises(ValueError, match=rf"results\.json: not the results of a run: .*{reason}"):
        read_run(tmp_path)


def test_complete_is_true_or_false(tmp_path: Path, make_result: MakeResult) -> None:
    write_reports(tmp_path, RunContent("a-run", [make_result()]))
    text = (tmp_path / "results.json").read_text()
    (tmp_path / "results.json").write_text(text.replace('"complete": true', '"complete": "no"'))
    with pytest.raises(ValueError, match="'complete' must be true or false, found 'no'"):
        read_run(tmp_path)


def test_a_subject_of_another_form_is_refused(tmp_path: Path, make_result: MakeResult) -> None:
    write_reports(tmp_path, RunContent("a-run", [make_result()]))
    text = (tmp_path / "results.json").read_text()
    (tmp_path / "results.json").write_text(text.replace('"subjects": {}', '"subjects": {"a": {"title": 1}}'))
    with pytest.raises(ValueError, match="subject"):
        read_run(tmp_path)
