"""Controllers from outside in the cars of a train, one instance a car, all in one child process."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from uictest.controllers import EXCHANGE, ControllerError
from uictest.judging.evaluation import json_form
from uictest.plans.scenario import ScenarioErrors, load
from uictest.rig import (
    assemble,
    assemble_train,
    coupling_of,
    run_coupled,
    run_in_process,
    run_train_in_process,
    simulate_cars,
)
from uictest.rig.external import worker
from uictest.rig.external.workers import Workers
from uictest.running.campaign import RecordingRequest, RunSettings, run_cases

from .test_workers import children

TRAIN = """\
schema: uictest/scenario/1
name: {name}
initial_speed: 14 km/h
until: 12 km/h
rail: {{condition: wet-cleaning, friction: 0.05}}
criteria: uictest-rig
expect: skipped
train: [{cars}]
"""
BUILT_IN = "{}"
AT = 30
"""Cycle of the faults."""


def python(fault="none", limit="60 s", file="bad.py"):
    parameters = f"{{fault: {fault}, at: {AT}}}"
    return f"{{controller: {{python: {file}, class: Bad, parameters: {parameters}, time_limit: {limit}}}}}"


def in_c(fault="none", limit="60 s"):
    parameters = f"{{fault: {fault}, at: {AT}}}"
    return f"{{controller: {{library: libbad.so, parameters: {parameters}, time_limit: {limit}}}}}"


@pytest.fixture
def cases(folder):
    """The cases of a train of some cars."""

    def write(*cars, name="train"):
        path = folder / f"{name}.yaml"
        path.write_text(TRAIN.format(name=name, cars=", ".join(cars)), "utf-8")
        return load([path])

    return write


@pytest.fixture
def train_of(cases):
    """What the rig is given for it."""

    def inputs(*cars):
        loaded = cases(*cars)
        return assemble_train(list(loaded[0].cars), coupling_of(loaded[0].scenario))

    return inputs


def bits(car):
    arrays = car.measures, car.wheelset_measures, car.car, car.wheelsets, *car.trace
    return [each.tobytes() for each in arrays]


@pytest.mark.parametrize("car", [python(), in_c()], ids=["python", "library"])
def test_a_train_of_one_car_has_the_bits_and_the_name_of_a_car_alone(cases, library, car):
    library()
    (case,) = (replace(each, train=None) for each in cases(car))
    alone = run_in_process(assemble(case), 10)
    train = run_coupled([case], coupling_of(case.scenario), 10, run_train_in_process)
    left = replace(train.cars[0], car=alone.car)  # of a train it notes that its measures are closed
    assert bits(left) == bits(alone)
    assert (train.cars[0].controller_version, train.cars[0].contract) == ("1.2", 1)
    own = assemble_train([case], coupling_of(case.scenario)).configs[0]
    assert own == assemble(case).config


def test_a_child_process_gives_the_bits_of_this_one(workers, train_of, library):
    """Programs of several kinds, some built in: all but those have what they say of themselves."""
    library()
    cars = python(), BUILT_IN, in_c(), BUILT_IN, python()
    here = run_train_in_process(train_of(*cars), 10)
    there = workers.run_train(train_of(*cars), 10)
    assert [bits(car) for car in here.cars] == [bits(car) for car in there.cars]
    assert here.couplers.tobytes() == there.couplers.tobytes()
    for stop in (here, there):
        assert [car.controller_version for car in stop.cars] == ["1.2", "", "1.2", "", "1.2"]


def test_the_stop_of_each_car_has_a_name_of_its_own_that_the_cars_and_its_program_decide(train_of):
    first, second = train_of(python(), python()), train_of(python(), "{brake: {command: 90 %}}", python())
    names = [config.case_sha256 for train in (first, second) for config in train.configs if config]
    assert len({*names}) == 4
    # As for a car alone, whose stop keeps its name when its controller is changed.
    Path("other.py").write_text(Path("bad.py").read_text("utf-8") + "\n", "utf-8")
    before = [config.case_sha256 for config in train_of(python(), python("raise", file="other.py")).configs]
    shutil.copy("bad.py", "other.py")
    after = [config.case_sha256 for config in train_of(python(), python("raise", file="other.py")).configs]
    assert (after[0] != before[0], after[1] == before[1]) == (True, True)


def test_cars_whose_library_has_one_state_for_all_are_an_error(workers, train_of, library):
    library("-DSHARED")
    told = r"^car 2 \(libbad\.so\): uictest_create returned a controller that is in use"
    with pytest.raises(ControllerError, match=told):
        workers.run_train(train_of(in_c(), in_c()), 0)
    assert workers.run_train(train_of(in_c(), BUILT_IN), 0).cars[0].controller_version == "1.2"


@pytest.mark.parametrize(
    ("car", "told"),
    [
        (python("crash"), r"car 3 \(bad\.py\): crashed with SIGSEGV \(cycle 30\)"),
        (python("hang", "0.5 s"), r"car 3 \(bad\.py\): step did not return within 0.5 s \(cycle 30\)"),
        (python("raise"), r"car 3 \(bad\.py\): step failed: ValueError: told to \(bad\.py, line \d+\) \("),
        (python("nan"), r"car 3 \(bad\.py\): step failed: hold\[0\] is nan, expected 0 or 1 \(cycle 30\)"),
        (python("create"), r"car 3 \(bad\.py\): Bad\(config\) failed: ValueError: told to"),
        (in_c("crash"), r"car 3 \(libbad\.so\): crashed with SIGSEGV \(cycle 30\)"),
        (in_c("forbidden"), r"car 3 \(libbad\.so\): forbidden command for wheelset 2: .* \(cycle 30\)"),
        (in_c("beyond"), r"car 3 \(libbad\.so\): the controller wrote beyond its outputs \(cycle 30\)"),
        (in_c("reset"), r"car 3 \(libbad\.so\): uictest_reset returned 7: told to"),
        (in_c("destroy"), r"car 3 \(libbad\.so\): destroy crashed with SIGABRT"),
        (in_c("step-abort"), r"car 3 \(libbad\.so\): last_error crashed with SIGABRT \(cycle 30\)"),
        (in_c("step-pointer"), r"car 3 \(libbad\.so\): last_error crashed with SIGSEGV \(cycle 30\)"),
        (
            in_c("step-hang", "0.5 s"),
            r"car 3 \(libbad\.so\): last_error did not return within 0.5 s \(cycle 30\)",
        ),
        (in_c("others-calling"), r"car 3 \(libbad\.so\): crashed with SIGABRT \(cycle 30\)"),
    ],
)
def test_a_fault_names_the_car_the_program_and_the_cycle(workers, train_of, library, car, told, monkeypatch):
    monkeypatch.setattr(worker, "OPENING_LIMIT", 0.5 if "step-hang" in car else worker.OPENING_LIMIT)
    library()
    sound = in_c() if "libbad" in car else python()
    with pytest.raises(ControllerError, match=f"^{told}"):
        workers.run_train(train_of(BUILT_IN, sound, car, sound))


@pytest.mark.parametrize("place", ["failure", "wheelset", "guard", "forbidden"])
def test_the_car_in_whose_call_what_is_noted_on_another_changes_is_told(workers, train_of, library, place):
    """Car 3 writes over what the rig notes on car 2, also as if that had given a forbidden command."""
    library()
    cycle = 0 if place == "guard" else AT
    told = rf"^car 3 \(libbad\.so\): the controller wrote beyond its outputs \(cycle {cycle}\)$"
    with pytest.raises(ControllerError, match=told):
        workers.run_train(train_of(BUILT_IN, in_c(), in_c(f"others-{place}")))


@pytest.mark.parametrize("records", [1, 2], ids=["itself", "the car behind"])
def test_a_car_is_told_that_notes_a_failure_of(workers, train_of, library, records):
    library(f"-DRECORDS_AHEAD={records * EXCHANGE.itemsize}")
    told = rf"^car 2 \(libbad\.so\): the controller wrote beyond its outputs \(cycle {AT}\)$"
    with pytest.raises(ControllerError, match=told):
        workers.run_train(train_of(BUILT_IN, in_c("others-forbidden"), in_c()))


def test_the_leading_one_of_two_cars_that_fail_at_once_is_told(train_of, library):
    library()
    with pytest.raises(ControllerError, match=r"^car 2 \(libbad\.so\): forbidden"):
        run_train_in_process(train_of(BUILT_IN, in_c("forbidden"), in_c("magnet")))


def test_a_fault_ends_its_train_and_leaves_the_others_and_no_process(cases):
    before = children()
    loaded = [
        *cases(python(), BUILT_IN, name="sound"),
        *cases(BUILT_IN, python("exit"), name="broken"),
        *cases(python(), BUILT_IN, name="again"),
    ]
    results = run_cases(loaded, RunSettings(jobs=2, recording=RecordingRequest("none"))).whole()
    assert children() - before == set()
    outcomes = [result.outcome for result in results]
    assert outcomes[:2] == outcomes[4:] != ["error"] * 2
    assert outcomes[2:4] == ["error"] * 2
    for result in results[2:4]:
        assert result.reason == ("controller: car 2 (bad.py): ended its process with exit code 3 (cycle 30)")
    assert json_form(results[0].measures) == json_form(results[4].measures)
    assert [bool(result.case_sha256) for result in results] == [True, False, False, True, True, False]
    assert [result.controller_contract for result in results] == [1, 0, 0, 0, 1, 0]


def test_recordings_have_the_channels_and_the_name_of_each_cars_own_controller(cases, library):
    library()
    stops = simulate_cars(cases(python(), BUILT_IN, in_c()), 0.01, run_train_in_process)
    assert ["diagnosis" in stop.recording.channels for stop in stops] == [True, False, True]
    assert [stop.controller_contract for stop in stops] == [1, 0, 1]
    facts = [stop.recording.metadata for stop in stops]
    assert [each["controller"] for each in facts] == ["Bad", "threshold", "libbad"]
    # That of the library is known once it is asked.
    assert [each.get("controller_version") for each in facts] == ["1.2", None, "1.2"]


def test_a_process_serves_the_trains_of_one_set_of_programs(train_of, library):
    """A library is not loaded into the process of a class, which it may damage, unless a train has both."""
    library()
    before = children()
    with Workers() as own:
        for cars, processes in (
            ([python(), python()], 1),
            ([python(), BUILT_IN], 1),
            ([in_c(), in_c()], 2),
            ([python(), in_c()], 3),
            ([in_c(), python(), python()], 3),
        ):
            own.run_train(train_of(*cars))
            assert len(children() - before) == processes
    assert children() - before == set()


def test_programs_of_several_folders_do_not_run_in_one_process(folder, cases):
    """A process holds one module of a name: that of one folder would serve the other's program."""
    (folder / "other").mkdir()
    shutil.copy(folder / "bad.py", folder / "other")
    with pytest.raises(
        ScenarioErrors, match=r"(?s)train\.1\.controller: its controller is loaded from .*other"
    ):
        cases(python(), python(file="other/bad.py"))
