"""One sweep at a time works in a folder."""

from pathlib import Path

import pytest

from uictest.core.files import FolderLock

SWEEP = """schema: uictest/scenario/1
name: study
extends: stop.yaml
vary: {ranges: {initial_speed: {first: 20 km/h, last: 30 km/h, count: 20}}}
"""
COMMAND = ("sweep", "scenarios/study.sweep.yaml", "-q")


@pytest.fixture
def folder(scenario):
    scenario("stop")
    Path("scenarios/study.sweep.yaml").write_text(SWEEP)
    place = Path("reports/study")
    place.mkdir(parents=True)
    return place


@pytest.mark.parametrize("options", [(), ("--restart",), ("--shard", "1/2"), ("--shard", "1/2", "--restart")])
def test_a_second_one_is_rejected_and_touches_nothing(call, folder, options):
    with FolderLock(folder):
        answer = call(*COMMAND, *options, code=4, says=f"{folder} is in use by process")
        assert "-o" in answer.err
        assert [path.name for path in folder.iterdir()] == [".uictest.lock"]


def test_shards_share_a_folder_and_nobody_discards_their_chunks(call, folder):
    with FolderLock(folder, shared=True):
        assert call(*COMMAND, "--shard", "1/2").code == 0
        for options in ((), ("--shard", "2/2", "--restart")):
            assert call(*COMMAND, *options).code == 4
        assert call(*COMMAND, "--shard", "2/2").code == 0
    assert call(*COMMAND).code == 0
    assert not (folder / ".uictest.lock").exists()
