"""Series of trains: the cars that are judged, and what is refused."""

import pytest

from uictest import rig
from uictest.analysis.firmness import Effort
from uictest.judging import series as judging
from uictest.judging.evaluation import relative_margin, result_document, to_json
from uictest.plans import series, sweeps
from uictest.plans.scenario import ScenarioErrors
from uictest.running.campaign import RecordingRequest, RunSettings, run_cases
from uictest.runs.batch import run_series
from uictest.runs.firmness import FirmnessRun

PAIR = "dry: dry.yaml\nwet: wet.yaml\n"
SCENARIO = """
schema: uictest/scenario/1
name: {name}
initial_speed: 40 km/h
rail: {rail}
criteria: uictest-stop
{more}
"""
RAILS = {"dry": "{condition: dry}", "wet": "{condition: wet, friction: 0.04}"}
TRAIN = "train: [{vehicle: intercity-180}, {vehicle: crh380a}]"
BAD_CAR = "train: [{}, {rig: {wsp: bypassed}}]"
PROFILE = """
schema: uictest/criteria/1
name: own
title: Own
sources: {own: {mark: chosen, text: of this test}}
criteria:
  - {id: rolls, source: own, layer: requirement, scope: series, measure: worst_locked_time,
     upper: {value: 10 s, source: own}}
  - {id: k-wet, source: own, layer: requirement, scope: series, measure: k_wet,
     lower: {value: 0.1, source: own}}
"""


@pytest.fixture
def of_trains(write, load):
    """Load a series whose scenarios say this of the train, or of the car alone."""

    def read(more, text="", wet=None):
        write("own.yaml", PROFILE)
        for name, rail in RAILS.items():
            own = wet if wet is not None and name == "wet" else more
            write(f"{name}.yaml", SCENARIO.format(name=name, rail=rail, more=own))
        return load(f"{PAIR}criteria: own.yaml\n{text}")

    return read


def judged(planned):
    settings = RunSettings(recording=RecordingRequest("none"))
    return judging.judge_results(planned, run_cases(planned.cases, settings).whole())


def written(result):
    """Return what is written of the cases of a series, and its figures; NaN is text here."""
    cases = to_json(result_document([each.case for each in result.cases]))
    return cases, repr((result.measures, result.criteria, result.outcome))


def refusal(read, *arguments):
    with pytest.raises(ScenarioErrors) as caught:
        read(*arguments)
    return [(each.key, each.message) for each in caught.value.diagnostics]


def test_the_first_car_is_judged_unless_all_are_and_the_wsp_of_all_is_bypassed(of_trains):
    (first,) = of_trains(TRAIN)
    assert (first.id, first.parameters) == ("campaign[car=1]", {"car": "1"})
    assert {stop.case.train.number for stop in first.stops} == {1}
    of_all = of_trains(TRAIN, "cars: all\n")
    assert [each.id for each in of_all] == ["campaign[car=1]", "campaign[car=2]"]
    for number, each in enumerate(of_all, start=1):
        assert {stop.case.train.number for stop in each.stops} == {number}
        assert {len(stop.case.cars) for stop in each.stops} == {2}
    names = ("dry", "wet", "bypassed.wet")
    assert [case.id for case in of_all[1].cases] == [f"campaign[car=2].{name}" for name in names]
    _, wet, bypassed = first.stops
    assert [car.scenario.rig.wsp for car in wet.case.cars] == ["active"] * 2
    assert [car.scenario.rig.wsp for car in bypassed.case.cars] == ["bypassed"] * 2
    assert bypassed.role == "bypassed"


def test_series_of_a_matrix_have_their_cars_each_and_run_only_with_those_of_their_own_train(of_trains):
    planned = of_trains(TRAIN, "cars: all\nmatrix: {controller: [threshold, slip-band]}\n")
    assert [each.id for each in planned] == [
        f"campaign[controller={name},car={car}]" for name in ("threshold", "slip-band") for car in (1, 2)
    ]
    trains = [[stop.case.train.train for stop in each.stops] for each in planned]
    threshold, slip_band = trains[0], trains[2]
    assert trains == [threshold, threshold, slip_band, slip_band]
    assert len({*threshold, *slip_band}) == 2 * 3


def test_every_train_is_simulated_once_for_the_series_of_all_cars(of_trains, monkeypatch):
    simulated, queued = [], rig.simulate_trains

    def noted(trains):
        simulated.extend([case.id for case in cars] for cars in trains)
        return queued(trains)

    def run(cases):
        return run_cases(cases, RunSettings(recording=RecordingRequest("none")))

    planned = of_trains(TRAIN, "cars: all\n")
    alone = [judged(each) for each in planned]
    monkeypatch.setattr(rig, "simulate_trains", noted)
    shown = []
    results = run_series(planned, run, maxfail=None, show=shown.append).whole()
    names = ("dry", "wet", "bypassed.wet")
    assert simulated == [[f"campaign[car={car}].{name}" for car in (1, 2)] for name in names]
    assert shown == results
    assert [written(each) for each in results] == [written(each) for each in alone]


def test_a_series_of_a_train_of_one_car_is_the_series_of_the_car(of_trains):
    def figures(more):
        (planned,) = of_trains(more)
        result = judged(planned)
        # A car of a train has no reference, even where it is the only one.
        of_alone = dict.fromkeys(("reference_distance_m", "distance_over_reference"))
        stops = [[{**each.case.measures, **of_alone}, each.case.wheelsets] for each in result.cases]
        shown = [
            stops,
            result.measures,
            result.criteria,
            result.outcome,
            result.bypassed_k_wet,
            result.speeds,
        ]
        return repr(shown).replace("[car=1]", "")  # NaN, which equals nothing, is text here

    assert figures("train: [{vehicle: crh380a}]") == figures("vehicle: crh380a")


def test_a_bad_car_fails_where_all_are_judged(of_trains):
    results = list(map(judged, of_trains(BAD_CAR, "cars: all\n")))
    verdicts = [{each.verdict.id: each.verdict.status for each in result.criteria} for result in results]
    assert [each["rolls"] for each in verdicts] == ["pass", "fail"]
    assert [result.met for result in results] == [True, False]
    assert [each.case.train.label for each in results[1].cases] == ["car 2 of 2"] * 2


def test_every_car_of_the_reference_is_that_of_the_wet_stop(of_trains):
    shown = "'campaign[car=1].wet' and the dry stop from 40 km/h differ in {}".format
    other = "train: [{vehicle: intercity-180}, {}]"
    assert refusal(of_trains, TRAIN, "", other) == [("wet", shown("'vehicle' of car 2"))]
    coupled = f"{TRAIN}\ncoupler: {{stiffness: 2 MN/m}}"
    assert refusal(of_trains, TRAIN, "", coupled) == [
        ("wet", shown(f"'coupler' of car {car}")) for car in (1, 2)
    ]
    piped = f"{TRAIN}\nbrake: {{transmission: {{pipe: 250 m/s}}}}"
    assert ("wet", shown("'brake.transmission' of car 1")) in refusal(of_trains, TRAIN, "", piped)


def test_all_stops_are_of_trains_of_one_length(of_trains):
    longer = "train: [{count: 3}]"
    assert refusal(of_trains, TRAIN, "", longer) == [
        ("wet", "'wet[car=1]' is of a train of 3, 'dry[car=1]' of a train of 2")
    ]
    assert refusal(of_trains, TRAIN, "", "vehicle: crh380a") == [
        ("wet", "'wet' is a car alone, 'dry[car=1]' of a train of 2")
    ]
    # Nothing else is said then, though the first stop is of a car alone.
    assert refusal(of_trains, "vehicle: crh380a", "cars: all\n", TRAIN) == [
        ("wet", "'wet[car=1]' is of a train of 2, 'dry' a car alone")
    ]


def test_cars_are_only_of_trains_and_recordings_of_one_car(of_trains, write):
    assert refusal(of_trains, "vehicle: crh380a", "cars: all\n") == [("cars", "the stops are of cars alone")]
    (planned,) = of_trains(TRAIN)
    recorded = "dry: {scenario: dry.yaml, recordings: [a.csv]}\nwet: wet.yaml\n"
    write("recorded.series.yaml", f"schema: uictest/series/1\nname: recorded\n{recorded}")
    assert refusal(series.load_series, planned.path.with_name("recorded.series.yaml")) == [
        ("dry", "'dry.yaml' is a train; recordings are of one car")
    ]


def test_how_firm_verdicts_are_is_said_of_the_car_that_is_judged(of_trains, monkeypatch):
    """By the stops of its car: the other one is held by brakes twice as strong."""
    ranged = sweeps.ranged_numbers
    monkeypatch.setattr(sweeps, "ranged_numbers", lambda stated: ranged(stated)[:1])
    strong = "train: [{}, {brake: {command: 50 %}}]\nrig: {topology: four-caliper}"
    planned = of_trains(strong, "cars: all\nrepeat: 1\n")
    run = FirmnessRun(2, effort=Effort(blocks=2, block=2, seeds=1, seeds_at_ends=1))
    for each in planned:
        firm, result = run.of_series(each), judged(each)
        assert firm.nominal == result.outcome
        verdicts = [(own.verdict.id, relative_margin(own.verdict)) for own in result.criteria]
        assert [(own.criterion, own.margin) for own in firm.criteria] == verdicts
