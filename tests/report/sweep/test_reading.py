from __future__ import annotations

import json
from pathlib import Path

import pytest

from uictest.report import write_recording
from uictest.report.sweep.folder import read_sweep
from uictest.report.sweep.result import sweep_document

from ..builders import MakeSweep, make_recording, make_result


@pytest.fixture
def folder(make_sweep: MakeSweep) -> Path:
    """The folder of a finished sweep with one case worth looking at."""
    content = make_sweep((make_result(),))
    document = sweep_document(content.result)
    (content.folder / "sweep.json").write_text(json.dumps(document))
    (content.folder / "manifest.json").write_text(json.dumps(content.manifest))
    return content.folder


def test_a_sweep_is_read_back(folder: Path, make_sweep: MakeSweep) -> None:
    content = read_sweep(folder)
    assert sweep_document(content.result) == sweep_document(make_sweep((make_result(),)).result)
    assert (content.folder, content.manifest) == (folder, make_sweep().manifest)
    assert content.traces == {}


def test_its_recordings_are_read_where_they_are_to_be_drawn(folder: Path) -> None:
    write_recording(folder, "dry-120[command=90]", make_recording(400))
    assert list(read_sweep(folder, traces=True).traces) == ["dry-120[command=90]"]


@pytest.mark.parametrize("text", ["", "[]", "{", '{"schema": "uictest/result/1"}'])
def test_what_is_no_sweep_is_rejected(folder: Path, text: str) -> None:
    (folder / "sweep.json").write_text(text)
    with pytest.raises(ValueError, match=r"sweep\.json"):
        read_sweep(folder)


@pytest.mark.parametrize("worst", [[{}], [1], 1])
def test_a_case_that_is_none_is_rejected(folder: Path, worst: object) -> None:
    document = json.loads((folder / "sweep.json").read_text())
    (folder / "sweep.json").write_text(json.dumps(document | {"worst": worst}))
    with pytest.raises(ValueError, match="not the result of a sweep"):
        read_sweep(folder)


def test_an_id_of_a_worst_case_that_is_a_path_is_refused(folder: Path) -> None:
    written = json.loads((folder / "sweep.json").read_text())
    written["worst"][0]["id"] = "../escaped"
    (folder / "sweep.json").write_text(json.dumps(written))
    with pytest.raises(ValueError, match=r"sweep\.json: .*is not the name of a file"):
        read_sweep(folder)
