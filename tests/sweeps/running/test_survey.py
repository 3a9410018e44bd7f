"""Sweeps in survey steps: fast where the verdict is clear, in regular steps where a bias could decide it."""

from dataclasses import replace

import numpy as np
import pytest

from uictest import rig
from uictest.plans import library
from uictest.plans.scenario import ScenarioErrors, load as load_scenarios
from uictest.plans.sweeps import in_survey_step
from uictest.report import survey_notes
from uictest.running.chunked import CaseSelection, chunk_runner, sweep_manifest
from uictest.running.chunked.store import program_digest
from uictest.running.chunked.table import biases_by_measure, survey_biases, survey_step

from ..conftest import MATRIX, SCENARIO, made_up, rows

SURVEY = "simulation.time_step=survey"
IN_FILE = "simulation.time_step: [survey]\n"
NO_BIAS = dict.fromkeys(biases_by_measure(), 0.0)


@pytest.fixture
def survey():
    """A runner of a survey whose stops are the formula, with the biases that are given."""
    return lambda plan, **biases: made_up(plan, survey_biases={**NO_BIAS, **biases})


@pytest.mark.parametrize(("text", "overrides"), [(MATRIX, [SURVEY]), (f"{MATRIX}  {IN_FILE}", [])])
def test_the_survey_step_is_asked_for_alone_and_varies_nothing(load, text, overrides):
    plan = load(text, *overrides)
    assert plan.survey
    assert plan.keys == ("rail.friction", "brake.command")
    assert plan.base.scenario.simulation.time_step == 0.0005
    assert in_survey_step(plan.base).scenario.simulation.time_step == 0.001


def test_only_the_last_step_of_the_command_line_counts(load):
    plan = load(f"{MATRIX}  {IN_FILE}", "simulation.time_step=0.25 ms")
    assert not plan.survey
    assert plan.base.scenario.simulation.time_step == 0.00025
    assert load(MATRIX, "simulation.time_step=0.25 ms", SURVEY).survey


@pytest.mark.parametrize("values", ["survey,0.5 ms", "0.5 ms,survey"])
def test_survey_is_no_value_among_others(load, values):
    with pytest.raises(ScenarioErrors, match="'survey' is the time step of a whole sweep"):
        load(MATRIX, f"simulation.time_step={values}")


def test_a_scenario_has_no_survey_step_and_the_bias_is_not_known_beside_another_step(load, tmp_path):
    path = tmp_path / "stop.yaml"
    path.write_text(f"{SCENARIO}simulation: {{time_step: survey}}\n")
    with pytest.raises(ScenarioErrors) as caught:
        load_scenarios([path])
    [error] = caught.value.diagnostics
    assert (error.key, error.line) == ("simulation.time_step", 5)
    assert "uictest sweep ... --set simulation.time_step=survey" in error.hint
    with pytest.raises(ScenarioErrors, match=r"known beside 0\.5 ms; the scenario is run in 0\.25 ms"):
        load(MATRIX, SURVEY, stop=f"{SCENARIO}simulation: {{time_step: 0.25 ms}}\n")


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("matrix: {simulation: [{time_step: 0.25 ms}, {time_step: 0.5 ms}]}\n", "simulation"),
        (f"{MATRIX}zip: {{simulation.time_step: [0.25 ms, 0.5 ms], seed: [1, 2]}}\n", "simulation.time_step"),
    ],
)
def test_no_step_varies_beside_the_survey(load, text, key):
    in_file = text.replace("matrix: {", f"matrix: {{{IN_FILE.strip()}, ") if "zip" not in text else text
    in_file = in_file.replace("matrix:\n", f"matrix:\n  {IN_FILE}")
    with pytest.raises(ScenarioErrors, match=f"'{key}' cannot vary: the survey step is that of all cases"):
        load(in_file)


def test_only_cases_within_their_bias_of_a_limit_are_repeated(load, survey):
    """The formula locks a wheelset for 5 (command - 9 friction) s; at most 1 s is accepted."""
    plan = load(MATRIX, SURVEY, "criteria=uictest-stop")
    found = rows(survey(plan, longest_lock=0.4).run(np.arange(plan.size)))
    locks = [5.0 * (row["values.brake.command"] - 9.0 * row["values.rail.friction"]) for row in found]
    near = [abs(lock - 1.0) < 0.4 * abs(lock) for lock in locks]
    assert [row["time_step_ms"] for row in found] == [0.5 if each else 1.0 for each in near]
    assert 0 < sum(near) < len(near)


WITHOUT_LOCK = {name: bias for name, bias in NO_BIAS.items() if name != "longest_lock"}


@pytest.mark.parametrize(
    ("criteria", "biases", "step"),
    [
        ("uictest-stop", NO_BIAS, 1.0),
        ("uictest-stop", WITHOUT_LOCK, 0.5),
        # In the formula nothing saturates: 0 s at a limit of 0 s.
        ("uictest-rig", NO_BIAS, 1.0),
        ("uictest-rig", {**NO_BIAS, "loadcell_saturation": 0.1}, 0.5),
        # Criteria of a series decide nothing in a case.
        ("uictest-wsp", NO_BIAS, 1.0),
    ],
)
def test_all_is_repeated_for_an_unknown_bias_or_one_at_the_limit_and_nothing_without(
    load, criteria, biases, step
):
    plan = load(MATRIX, SURVEY, f"criteria={criteria}")
    found = rows(made_up(plan, survey_biases=biases).run(np.arange(plan.size)))
    assert {row["time_step_ms"] for row in found} == {step}


def test_what_the_survey_step_cannot_simulate_is_repeated(load, survey):
    plan = load("matrix: {controller.cycle_time: [10 ms, 2.5 ms]}\n", SURVEY)
    found = rows(survey(plan).run(np.arange(2)))
    assert [row["time_step_ms"] for row in found] == [1.0, 0.5]
    assert "error" not in {row["outcome"] for row in found}


def test_a_repeated_case_is_that_of_regular_steps_and_another_that_of_the_longer_ones(load):
    text = "matrix: {rail.friction: [0.05, 0.08], brake.command: [80 %, 100 %], criteria: [uictest-stop]}\n"
    beside = {
        step: rows(chunk_runner(load(text, f"simulation.time_step={step}"), rig.run_block).run(np.arange(4)))
        for step in ("0.5 ms", "1 ms")
    }
    energies = sorted(max(row[f"contact_energy_kj_{k}"] for k in range(1, 5)) for row in beside["1 ms"])
    share = 1500.0 / (0.5 * (energies[1] + energies[2])) - 1.0  # half of the stops lie within it of 1500 kJ
    runner = chunk_runner(load(text, SURVEY), rig.run_block)
    stops = replace(runner.stops, survey_biases=NO_BIAS | {"contact_energy": share})
    found = rows(replace(runner, stops=stops).run(np.arange(4)))
    assert {row["time_step_ms"] for row in found} == {0.5, 1.0}
    for place, row in enumerate(found):
        step = "0.5 ms" if row.pop("time_step_ms") == 0.5 else "1 ms"
        assert row == beside[step][place]
    assert beside["0.5 ms"] != beside["1 ms"]


def test_a_sweep_depends_on_whether_it_is_a_survey_and_on_the_biases(load, monkeypatch):
    def manifest(*overrides):
        selection = CaseSelection(load(MATRIX, *overrides))
        return sweep_manifest(selection, expression=None, overrides=(), seed=None)

    assert manifest(SURVEY) == manifest() | {"time_step": "survey"}
    before = program_digest.__wrapped__()
    monkeypatch.setattr(library, "table", lambda name: "another table")
    assert program_digest.__wrapped__() != before


def test_the_bias_of_every_criterion_of_the_library_is_known(load):
    plan = load(MATRIX, SURVEY, "criteria=[uic-541-05-appendix-b,uictest-rig,uictest-stop]")
    survey = survey_step(plan, 2, ["valve_actuations"])
    judged = {each.measure for profile in plan.base.scenario.judged_by for each in profile.criteria}
    assert judged | {"valve_actuations"} == {each.measure for each in survey.biases}
    assert (survey.time_step, survey.regular_step, survey.repeated) == ("1 ms", "0.5 ms", 2)
    assert survey.unknown == ()
    settled = (
        "survey in steps of 1 ms, which could not settle 2 of 6 cases: these were repeated in steps of 0.5 ms"
    )
    assert next(survey_notes(survey, 6)) == settled
    assert survey_step(load(), 0, []) is None


def test_a_measure_without_a_bias_is_named_and_one_has_the_largest_of_any_shipped_case(load, monkeypatch):
    known = {name: each for name, each in survey_biases().items() if name != "longest_lock"}
    monkeypatch.setattr("uictest.running.chunked.table.survey_biases", lambda: known)
    survey = survey_step(load(MATRIX, SURVEY, "criteria=[uictest-stop,uictest-wsp]"), 6, [])
    assert survey.unknown == ("longest_lock",)
    assert "bias of the survey step: not known of longest_lock" in list(survey_notes(survey, 6))
    known = survey_biases()
    assert known["standstill"].bias == 0.0
    assert 0.0 < known["braking_distance"].bias < known["braking_distance"].of_single_stops
