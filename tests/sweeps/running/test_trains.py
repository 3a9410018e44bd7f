"""Sweeps of trains: each car is a case with the bits of `uictest run`, whatever else is in its chunk."""

import math

import numpy as np
import pytest

from uictest import rig
from uictest.analysis.firmness import Effort
from uictest.plans import scenario, sweeps
from uictest.plans.scenario import ScenarioErrors
from uictest.running.campaign import RecordingRequest, RunSettings, run_cases
from uictest.running.chunked import CaseSelection, chunk_runner, select_cases
from uictest.runs import Observer, SweepRequest, firmness, run_sweep

from ..conftest import TRAIN, rows

MATRIX = """\
matrix:
  rail.friction: [0.04, 0.05]
  brake.command: [80 %, 100 %]
  train.1.brake.position: [R, P]
"""


@pytest.fixture
def loaded(load):
    return lambda text=MATRIX, *overrides: load(text, *overrides, stop=TRAIN)


def of_chunk(plan, indices):
    return rows(chunk_runner(plan, rig.run_block).run(np.array(indices)))


def known(figures, names=None):
    """The figures that have a value, of some names."""
    figures = {name: figures[name] for name in names or figures}
    return {name: value for name, value in figures.items() if value is not None and not math.isnan(value)}


def test_every_car_is_a_row_with_the_bits_of_the_same_case_of_a_scenario_in_whatever_chunk(loaded, tmp_path):
    plan = loaded()
    assert plan.size == 24
    found = of_chunk(plan, range(plan.size))
    path = tmp_path / "written.yaml"
    path.write_text(TRAIN + MATRIX)
    results = run_cases(scenario.load([path]), RunSettings(recording=RecordingRequest("none"))).whole()
    assert [row["id"] for row in found] == [result.id for result in results]
    for row, result in zip(found, results, strict=True):
        assert (row["outcome"], row["met"], row["parameters.car"]) == (
            *(result.outcome, result.met),
            result.parameters["car"],
        )
        assert known(row, result.measures) == known(result.measures)
        for place, wheelset in enumerate(result.wheelsets, start=1):
            of_row = {name: row[f"{name}_{place}"] for name in wheelset}
            assert known(of_row) == known(wheelset)
    assert len({row["energy_residual"] for row in found}) == 24
    assert of_chunk(plan, [4, 5, 6, 11]) == [found[place] for place in (4, 5, 6, 11)]
    selection = select_cases(plan, "car=2")
    assert of_chunk(plan, selection.indices(0, selection.size)) == found[1::3]


def test_cases_are_cars_of_their_trains_and_numbers_of_one_car_are_drawn(loaded):
    first, second, other = loaded().cases(np.array([3, 4, 23]))
    assert first.train.scenarios is second.train.scenarios
    assert (first.train.train, second.train.number) == (
        "study[friction=0.04,command=80,train.1.position=P]",
        2,
    )
    assert [each.brake.command for each in other.train.scenarios] == [1.0, 0.5, 0.5]
    assert other.train.scenarios[1] is other.train.scenarios[2] is other.scenario
    plan = loaded("sample: {size: 3, parameters: {train.0.vehicle.body.mass: {uniform: [30 t, 40 t]}}}\n")
    cases = plan.cases(np.arange(9))
    masses = [[float(car.vehicle.body.mass) for car in case.train.scenarios] for case in cases]
    assert all(30e3 <= leading <= 40e3 for leading, *_ in masses)
    assert len({leading for leading, *_ in masses}) == 3
    assert len({tuple(others) for _, *others in masses}) == 1


def test_a_train_that_cannot_run_is_an_error_of_its_cars_alone(loaded):
    plan = loaded("matrix: {coupler.damping: [0.8 MN s/m, 6 MN s/m], simulation.time_step: [0.5 ms, 1 ms]}\n")
    found = of_chunk(plan, range(plan.size))
    assert [row["outcome"] for row in found] == [*9 * ["skipped"], *3 * ["error"]]
    assert "coupler: too stiff or too much damped" in found[-1]["reason"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("matrix: {train.1.count: [1, 2]}\n", "the cars of a train and their number cannot vary"),
        ("matrix: {vehicle.load: [empty]}\n", "vehicles of their own"),
        ("matrix: {simulation.time_step: [survey]}\n", "what the survey step does to trains is not known"),
        (
            "sample: {method: saltelli, size: 4, parameters: {rail.friction: {uniform: [0.1, 0.2]}}}\n",
            "sensitivities are of a car alone",
        ),
    ],
)
def test_what_a_sweep_of_trains_cannot_is_refused_at_its_key(loaded, text, message):
    with pytest.raises(ScenarioErrors, match=message):
        loaded(text)


def test_a_sweep_says_of_every_car_of_the_nominal_train_how_firm_it_is(load, tmp_path, monkeypatch):
    monkeypatch.setattr(firmness, "EFFORT", Effort(blocks=2, block=2, seeds=1, seeds_at_ends=1))
    ranged = sweeps.ranged_numbers
    monkeypatch.setattr(sweeps, "ranged_numbers", lambda stated: ranged(stated)[:2])
    train = TRAIN.replace("uictest-rig", "uictest-stop").replace("expect: skipped\n", "")
    plan = load("matrix: {rail.friction: [0.04]}\n", stop=train)
    request = SweepRequest(CaseSelection(plan), {"file": plan.file}, tmp_path / "study", jobs=2, firm=True)
    finished = run_sweep(request, Observer())
    assert [each.id for each in finished.result.nominal] == [f"study[car={car}]" for car in (1, 2, 3)]
    assert {each.firmness.draws for each in finished.result.nominal} == {4}
    path = tmp_path / "study.yaml"
    path.write_text(train)
    cases = run_cases(scenario.load([path]), RunSettings(recording=RecordingRequest("none"))).whole()
    read_back = finished.content.result.nominal
    assert [known(each.measures) for each in read_back] == [known(each.measures) for each in cases]
    assert "How firm study[car=3] is" in (request.folder / "index.html").read_text("utf-8")
    lines = (request.folder / "tables/firmness.csv").read_text("utf-8").splitlines()
    assert {line.split(",")[0] for line in lines[1:]} == {each.id for each in finished.result.nominal}


def test_a_key_that_every_car_has_of_its_own_reaches_none(load):
    own = TRAIN.replace("{}, {", "{brake: {command: 70 %}}, {")
    with pytest.raises(ScenarioErrors, match="every car has one of its own"):
        load("matrix: {brake.command: [80 %, 100 %]}\n", stop=own)
