import json

import pytest

from uictest.report import write_recording
from uictest.report.sweep.result import read_sweep, sweep_document

from ..builders import make_recording, make_result


@pytest.fixture
def folder(make_sweep):
    """The folder of a finished sweep with one case worth looking at."""
    content = make_sweep((make_result(),))
    document = sweep_document(content.result)
    (content.folder / "results.json").write_text(json.dumps(document))
    (content.folder / "manifest.json").write_text(json.dumps(content.manifest))
    return content.folder


def test_a_sweep_is_read_back(folder, make_sweep):
    content = read_sweep(folder)
    assert sweep_document(content.result) == sweep_document(make_sweep((make_result(),)).result)
    assert (content.folder, content.manifest) == (folder, make_sweep().manifest)
    assert content.traces == {}


def test_its_recordings_are_read_where_they_are_to_be_drawn(folder):
    write_recording(folder, "dry-120[command=90]", make_recording(400))
    assert list(read_sweep(folder, traces=True).traces) == ["dry-120[command=90]"]


@pytest.mark.parametrize("text", ["", "[]", "{", '{"schema": "uictest/result/1"}'])
def test_what_is_no_sweep_is_rejected(folder, text):
    (folder / "results.json").write_text(text)
    with pytest.raises(ValueError, match=r"results\.json"):
        read_sweep(folder)


def test_a_worst_case_that_is_none_or_whose_id_is_a_path_is_refused(folder):
    document = json.loads((folder / "results.json").read_text())
    escaped = {**document["worst"][0], "id": "../escaped"}
    wrong = "not the result of a sweep"
    reasons = [([{}], wrong), ([1], wrong), (1, wrong), ([escaped], ".*is not the name of a file")]
    for worst, reason in reasons:
        (folder / "results.json").write_text(json.dumps(document | {"worst": worst}))
        with pytest.raises(ValueError, match=rf"results\.json: {reason}"):
            read_sweep(folder)
