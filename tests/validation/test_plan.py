"""What a validation file may say, and where its errors are."""

import pytest

from uictest.plans import series
from uictest.plans.scenario import ScenarioErrors
from uictest.plans.series import load_validation, plan_of_series

STOP = "schema: uictest/scenario/1\nname: {name}\ninitial_speed: 100 km/h\nrail: {{condition: {rail}}}\n"
ONE = "{scenario: dry.yaml, recordings: [one.csv]"
BEGIN = "schema: uictest/validation/1\nname: my-train\nstops:\n"


@pytest.fixture
def write(write):
    """Write a file into the working folder, which holds two scenarios and two recordings."""
    for name, rail in (("dry", "dry"), ("wet", "wet")):
        write(f"{name}.yaml", STOP.format(name=name, rail=rail))
    for name in ("one", "two"):
        write(f"{name}.csv", "time\n")
    return write


def test_every_entry_is_one_case_with_its_recordings(write):
    text = """
  - {scenario: dry.yaml, recordings: [one.csv], repeat: 5, set: {brake.command: 80 %}}
  - {scenario: wet.yaml, recordings: [two.csv], map: common-names, tuned: true}
speed_tolerance: 5 km/h
"""
    plan = load_validation(write("v.yaml", BEGIN + text), ["rail.gradient=1 permille"])
    first, second = plan.comparisons
    assert first.case.id.startswith("my-train.dry[")
    assert (first.case.scenario.repeat, float(first.case.scenario.brake.command)) == (5, 0.8)
    assert {float(each.case.scenario.rail.gradient) for each in plan.comparisons} == {0.001}
    assert [each.recorded.files[0].name for each in plan.comparisons] == ["one.csv", "two.csv"]
    assert (first.recorded.channel_map, second.recorded.channel_map) == ("uictest", "common-names")
    assert (first.tuned, second.tuned) == (False, True)
    assert (plan.speed_tolerance, plan.confidence) == (pytest.approx(5 / 3.6), 0.95)
    assert {"v.yaml", "dry.yaml", "wet.yaml"} <= set(plan.inputs)


@pytest.mark.parametrize(
    ("stops", "message"),
    [
        ("[{scenario: dry.yaml, recordings: [three.csv]}]", "no such file: 'three.csv'"),
        ("[{scenario: dry.yaml}]", "missing key 'recordings'"),
        ("[{scenario: dry.yaml, recordings: []}]", "recordings"),
        (f"[{ONE}}}, {{scenario: wet.yaml, recordings: [one.csv]}}]", "'one.csv' is named twice"),
        (f"[{ONE}, set: {{seed: [1, 2]}}}}]", "recordings belong to one stop, the scenario has 2 cases"),
        ("[]", "an empty list"),
        (f"[{ONE}, tune: true}}]", "did you mean"),
        ("[{scenario: ../dry.yaml, recordings: [one.csv]}]", "dry.yaml"),
    ],
)
def test_what_cannot_be_compared_is_refused_at_its_place(write, stops, message):
    with pytest.raises(ScenarioErrors) as errors:
        load_validation(write("v.yaml", f"{BEGIN}  {stops}\n"))
    assert message in str(errors.value)
    assert "v.yaml:" in str(errors.value)


def test_all_recordings_that_are_named_twice_are_told_at_once(write):
    entry = "  - {scenario: dry.yaml, recordings: [one.csv, two.csv]}\n"
    with pytest.raises(ScenarioErrors) as errors:
        load_validation(write("v.yaml", BEGIN + 2 * entry))
    assert [each.line for each in errors.value.diagnostics] == [5, 5]


@pytest.mark.parametrize(
    ("schema", "hint"),
    [
        ("", "write `schema: uictest/validation/1`"),
        ("schema: uictest/scenario/1\n", "a scenario is run with `uictest run`"),
    ],
)
def test_another_kind_of_file_is_refused(write, schema, hint):
    with pytest.raises(ScenarioErrors, match=hint):
        load_validation(write("v.yaml", f"{schema}name: v\nstops: []\n"))


def test_a_series_is_validated_by_those_of_its_stops_that_name_recordings(write):
    text = """schema: uictest/series/1
name: campaign
dry: {scenario: dry.yaml, recordings: [one.csv]}
wet: wet.yaml
speed_tolerance: 2 km/h
"""
    [planned] = series.load_series(write("campaign.series.yaml", text))
    plan = plan_of_series(planned)
    assert [(each.case.id, each.tuned) for each in plan.comparisons] == [("campaign.dry", False)]
    assert plan.speed_tolerance == pytest.approx(2 / 3.6)
