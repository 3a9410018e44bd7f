"""The band of the repeats on the page of a run, against the same stops run one by one."""

from dataclasses import replace

import numpy as np
import pytest

import uictest
from uictest import report, runs
from uictest.core.units import BAR, KILOMETRE_PER_HOUR
from uictest.plans.scenario import load
from uictest.runs.batch import with_traces

STOP = """\
schema: uictest/scenario/1
name: stop
initial_speed: 30 km/h
rail: {condition: wet, friction: 0.05}
"""
SEEDS = (3, 4, 5, 6)
CHANNELS = {"speed": KILOMETRE_PER_HOUR, "wheel_speed_2": KILOMETRE_PER_HOUR, "cylinder_pressure_3": BAR}


def repeated(folder, further):
    """Return what reports show of a stop that is repeated, and the same once it is made again."""
    (folder / "stop.yaml").write_text(f"{STOP}{further}", "utf-8")
    cases = load([folder / "stop.yaml"])
    content = runs.run_batch(
        runs.batch_of(cases, [], ["run"], None), runs.Observer(), draws_stops=True
    ).content
    return content, with_traces(replace(content, traces={}), cases, {}, 0.01)


def test_the_band_spans_the_stops_as_they_are_alone_and_is_the_same_on_a_page_made_again(tmp_path):
    content, again = repeated(tmp_path, f"repeat: {len(SEEDS)}\nseed: {SEEDS[0]}\n")
    (trace,), (other,) = content.traces.values(), again.traces.values()
    (tmp_path / "alone.yaml").write_text(STOP, "utf-8")
    alone = [
        uictest.run(tmp_path / "alone.yaml", seed=seed, record="all", jobs=1).recording("stop")
        for seed in SEEDS
    ]
    assert trace.band_stops == len(SEEDS)
    for name, size in CHANNELS.items():
        low, high = trace.band[name]
        for stop in alone:
            time = stop["time"][stop["time"] <= trace.end]
            value = stop[name][: len(time)] / size
            assert np.all(np.interp(time, low.x, low.y) <= value + 1e-9)
            assert np.all(value - 1e-9 <= np.interp(time, high.x, high.y))
        assert low.y.min() == pytest.approx(
            min(np.min(stop[name][stop["time"] <= trace.end]) for stop in alone) / size, abs=0.1
        )
    assert trace.band.keys() == other.band.keys() > set(CHANNELS)
    for name, edges in trace.band.items():
        for edge, same in zip(edges, other.band[name], strict=True):
            assert np.array_equal(edge.x, same.x)
            assert np.array_equal(edge.y, same.y, equal_nan=True)


def test_only_so_many_stops_make_the_band(monkeypatch, tmp_path):
    monkeypatch.setattr(report, "BAND_STOPS", 2)
    for content in repeated(tmp_path, "repeat: 3\n"):
        assert [trace.band_stops for trace in content.traces.values()] == [2]
