from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from uictest.evaluation import CaseResult, cases_document
from uictest.recording import Recording
from uictest.report import CaseDescription, read_run, write_recording, write_reports

MakeResult = Callable[..., CaseResult]


def test_a_run_comes_back_from_its_folder(
    tmp_path: Path, make_result: MakeResult, make_recording: Callable[..., Recording]
) -> None:
    result, subject = make_result(), CaseDescription("A title", ("a",), {"rail": "dry"})
    write_reports(tmp_path, [result], {"seed": 3}, complete=False, subjects={result.id: subject})
    write_recording(tmp_path, result.id, make_recording())
    content = read_run(tmp_path, traces=True)
    assert cases_document(content.results) == cases_document([result])
    assert (content.name, content.manifest, content.complete) == (tmp_path.name, {"seed": 3}, False)
    assert content.subject(result.id) == subject
    assert content.subject("another") == CaseDescription()
    assert list(content.traces) == [result.id]
    assert read_run(tmp_path).traces == {}


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"schema": "uictest/result/1"}', '{"schema": "other"}'])
def test_what_is_no_run_is_refused_with_its_file(tmp_path: Path, text: str) -> None:
    (tmp_path / "results.json").write_text(text)
    with pytest.raises(ValueError, match=r"results\.json"):
        read_run(tmp_path)


def test_a_subject_of_another_form_is_refused(tmp_path: Path, make_result: MakeResult) -> None:
    write_reports(tmp_path, [make_result()], {}, complete=True)
    text = (tmp_path / "results.json").read_text()
    (tmp_path / "results.json").write_text(text.replace('"subjects": {}', '"subjects": {"a": {"title": 1}}'))
    with pytest.raises(ValueError, match="subject"):
        read_run(tmp_path)
