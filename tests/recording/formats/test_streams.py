"""Groups of a file with time bases of their own, block by block."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.recording import Group
from uictest.core.recording.formats import Dialect, mdf, read_pieces, tdms
from uictest.core.recording.formats.file_formats import UnreadableError
from uictest.core.recording.formats.pieces import in_step

FAST = 0.001


def blocks(name, interval, rows, count):
    """Yield a group whose samples are its times."""
    for k in range(count):
        time = interval * np.arange(k * rows, (k + 1) * rows)
        yield Group("", {name: time.copy()}, {}, time)


@given(st.sampled_from([0.1, 0.01, FAST]), st.integers(2, 400), st.integers(2, 500))
def test_every_part_has_the_samples_beside_it_and_no_row_is_lost(interval, rows, fast_rows):
    leading = blocks("speed", interval, rows, 3)
    lasts = 3 * rows * interval
    beside = blocks("pressure", FAST, fast_rows, int(lasts / FAST / fast_rows) + 1)
    parts = [contents.groups for contents in in_step([beside, leading], ["speed"])]
    np.testing.assert_array_equal(
        np.concatenate([own.channels["speed"] for own, _ in parts]), interval * np.arange(3 * rows)
    )
    for own, other in parts:
        inside = other.time[(other.time >= own.time[0]) & (other.time <= own.time[-1])]
        every = FAST * np.arange(round(own.time[-1] / FAST) + 1)
        np.testing.assert_array_equal(inside, every[(every >= own.time[0]) & (every <= own.time[-1])])


def test_a_fast_group_beside_a_slow_one_is_not_held_for_the_length_of_a_slow_block():
    slow, fast = blocks("speed", 0.1, 36_000, 1), blocks("pressure", FAST, 1000, 3600)
    held = [other.time.size for _, other in (each.groups for each in in_step([slow, fast], ["speed"]))]
    assert max(held) < 2 * 1000


def test_a_step_of_the_clock_by_years_takes_no_memory():
    time = np.array([0.0, 1.0, 8e8, 8e8 + 1.0])
    slow = iter([Group("", {"speed": time}, {}, time)])
    parts = in_step([slow, blocks("p", FAST, 9, 3)], ["speed"])
    sizes = [own.time.size for own, _ in (each.groups for each in parts)]
    assert sum(sizes) == 4


@pytest.mark.parametrize("count", [1, 2])
def test_groups_without_times_go_alone_only(count):
    groups = [iter([Group("", {f"speed{k}": np.zeros(3)}, {}, None)]) for k in range(count)]
    if count == 1:
        assert len(list(in_step(groups, ["speed0"]))) == 1
    else:
        with pytest.raises(UnreadableError, match="no times of its own"):
            list(in_step(groups, ["speed0"]))


@pytest.mark.parametrize("kind", ["tdms", "mdf"])
def test_blocks_know_their_first_row_where_the_file_has_no_times(tmp_path, monkeypatch, kind):
    samples, path = np.arange(60_000.0), tmp_path / f"a.{kind}"
    if kind == "tdms":
        nptdms = pytest.importorskip("nptdms")
        with nptdms.TdmsWriter(path) as writer:
            writer.write_segment([nptdms.ChannelObject("g", "v", samples)])
    else:
        asammdf = pytest.importorskip("asammdf")
        with asammdf.MDF() as file:
            file.append([asammdf.Signal(samples, 0.02 * samples, name="v")])
            path = file.save(tmp_path / "a.mf4")
    monkeypatch.setattr(tdms, "AT_ONCE", 7_000)
    monkeypatch.setattr(mdf, "AT_ONCE", 100_000)
    groups = [group for contents in read_pieces(path, Dialect()) for group in contents.groups]
    assert len(groups) > 1
    assert [group.first_row for group in groups] == [group.channels["v"][0] for group in groups]
