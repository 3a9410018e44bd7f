"""Sweeps of one scenario in a folder of their own, and a rig whose stops are a formula."""

import io
import shutil
from dataclasses import replace
from pathlib import Path
from textwrap import indent

import numpy as np
import pyarrow.parquet as pq
import pytest

from uictest import rig
from uictest.analysis.summaries import summarized
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.plans.scenario import load as load_scenarios
from uictest.plans.sweeps import load_sweep
from uictest.rig.model.rail import FRICTIONS
from uictest.running.chunked import ChunkRunner, ChunkStore
from uictest.running.chunked.many_stops import ManyStops

from ..c_compiler import build_library

SCENARIO = """\
schema: uictest/scenario/1
name: stop
initial_speed: 30 km/h
rail: {condition: wet, friction: 0.1}
"""
HEAD = "schema: uictest/scenario/1\nname: study\nextends: stop.yaml\n"
MATRIX = """\
matrix:
  rail.friction: [0.08, 0.10, 0.12]
  brake.command: [80 %, 100 %]
"""
TRAIN = """\
schema: uictest/scenario/1
name: study
initial_speed: 14 km/h
until: 12 km/h
rail: {condition: wet-cleaning, friction: 0.05}
criteria: uictest-rig
expect: skipped
train: [{}, {vehicle: crh380a, count: 2, brake: {command: 50 %}}]
"""
SLIP_BAND = Path(__file__).parent / "controllers"
"""A controller from outside with the commands of the built-in slip-band."""


def vary(sections):
    """What a scenario says of what varies."""
    return "vary:\n" + indent(sections, "  ")


@pytest.fixture
def load(tmp_path, monkeypatch):
    """The plan of a sweep whose file says the given text under `vary`; `stop` is what stop.yaml says."""
    monkeypatch.chdir(tmp_path)
    Path("stop.yaml").write_text(SCENARIO)

    def write_and_load(text=MATRIX, *overrides, stop=SCENARIO, **options):
        if stop != SCENARIO:
            Path("stop.yaml").write_text(stop)
        Path("study.sweep.yaml").write_text(HEAD + vary(text))
        return load_sweep(Path("study.sweep.yaml"), overrides, **options)

    return write_and_load


def written_out(plan, index, *overrides):
    """The case as `uictest run --set ...` would load it, with the id that it has in the sweep."""
    settings = plan.settings(np.array([index]))
    # A part first, then what lies inside it: an override of a part would take the inside with it.
    keys = sorted(settings, key=lambda key: key.count("."))
    texts = [f"{key}={settings[key][0].text}" for key in keys]
    case = load_scenarios([Path("stop.yaml")], [*overrides, *texts])[0]
    return replace(case, id=plan.ids(np.array([index]))[0], path=plan.base.path)


def rows(content):
    """The rows of a chunk."""
    return pq.read_table(io.BytesIO(content)).to_pylist()


def stored(selection, runner, folder):
    """A store with all chunks of a selection."""
    store = ChunkStore(folder)
    store.open({}, restart=True)
    for number in range(selection.chunks):
        store.write(number, runner.run(selection.chunk(number)))
    return store


def result_of(selection, store, pair=None):
    """The result of a sweep all of whose chunks are in the store; its tables lie there, too."""
    with summarized(selection, store, pair, ["braking_distance_m"]) as summary:
        return summary.result().result


def formula(parameters, wheelset_parameters, rail):
    """Stops as a point of mass makes them: every figure is a known function of friction and speed."""
    measures = np.zeros(parameters.size, STOP_MEASURES)
    wheelsets = np.zeros((parameters.size, 4), WHEELSET_MEASURES)
    speed, friction = parameters["initial_speed"], rail[:, FRICTIONS, 0]
    for name in STOP_MEASURES.names or ():
        measures[name] = np.nan
    measures["initial_speed"], measures["stopped"] = speed, 1.0
    measures["braking_time"] = measures["end_time"] = speed / (9.81 * friction)
    measures["braking_distance"] = measures["end_distance"] = speed**2 / (2.0 * 9.81 * friction)
    measures["reference_distance"] = measures["braking_distance"]  # it uses all of its rail
    for name in (
        "build_up_time",  # the brake is there at once
        "build_up_distance",
        "end_speed",
        "energy_residual",
        "air_residual",
        "air_energy_residual",
        "compensation_misfit",
        "line_saturation",
        "air_consumed",
        "reservoir_minimum_pressure",
        "reservoir_margin",
        "deceleration_bogie_1",
        "deceleration_bogie_2",
    ):
        measures[name] = 0.0
    # Wheels lock at high pressure on slippery rail: the only thing that a stop can fail by.
    wheelsets["longest_lock"] = (parameters["commanded_pressure"] * 1e-5 / 3.8 - 9.0 * friction)[
        :, None
    ] * 5.0
    return measures, wheelsets


def formula_of(case, simulate=formula):
    """The measures of the stop of a case, and of its wheelsets."""
    parameters, wheelset_parameters, rail, *_ = rig.assemble(case)
    measures, wheelsets = simulate(np.array([parameters]), wheelset_parameters[None], rail[None])
    return measures[0], wheelsets[0]


def made_up(plan, simulate=formula, **options):
    """A runner whose stops are the formula."""
    return ChunkRunner(plan, ManyStops(plan.keys, rig.run_block, simulate, **options))


@pytest.fixture
def library(tmp_path):
    """The controller slip-band as a shared library beside the sweep, as a scenario names it."""
    build_library(tmp_path / "libband.so", SLIP_BAND / "slip_band.c")
    return "libband.so"


@pytest.fixture
def python_file(tmp_path):
    """The controller slip-band as a class in a file beside the sweep, as a scenario names it."""
    shutil.copy(SLIP_BAND / "slip_band.py", tmp_path)
    return "slip_band.py, class: SlipBand"
