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


@pytest.fixture
def content(tmp_path):
    """What reports show of a stop that is repeated under four seeds."""
    (tmp_path / "stop.yaml").write_text(f"{STOP}repeat: {len(SEEDS)}\nseed: {SEEDS[0]}\n", "utf-8")
    batch = runs.batch_of(load([tmp_path / "stop.yaml"]), [], ["run"], None)
    return runs.run_batch(batch, runs.Observer(), draws_stops=True).content


def test_the_band_spans_the_stops_as_they_are_alone(content, tmp_path):
    (trace,) = content.traces.values()
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


def test_a_page_that_is_made_again_has_the_same_band(content, tmp_path):
    again = with_traces(replace(content, traces={}), load([tmp_path / "stop.yaml"]), {}, 0.01)
    (own,), (other,) = content.traces.values(), again.traces.values()
    assert own.band.keys() == other.band.keys() > set(CHANNELS)
    for name, edges in own.band.items():
        for edge, same in zip(edges, other.band[name], strict=True):
            assert np.array_equal(edge.x, same.x)
            assert np.array_equal(edge.y, same.y, equal_nan=True)


def test_only_so_many_stops_make_the_band(monkeypatch, tmp_path):
    monkeypatch.setattr(report, "BAND_STOPS", 2)
    (tmp_path / "stop.yaml").write_text(f"{STOP}repeat: 3\n", "utf-8")
    batch = runs.batch_of(load([tmp_path / "stop.yaml"]), [], ["run"], None)
    content = runs.run_batch(batch, runs.Observer(), draws_stops=True).content
    assert [trace.band_stops for trace in content.traces.values()] == [2]
    again = with_traces(replace(content, traces={}), load([tmp_path / "stop.yaml"]), {}, 0.01)
    assert [trace.band_stops for trace in again.traces.values()] == [2]
