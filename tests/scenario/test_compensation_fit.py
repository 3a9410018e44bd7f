"""Whether a compensation was identified for the rig of a stop."""

import pytest

from uictest.plans.scenario import ScenarioErrors, misfits, rig_differences


def told(case):
    return [str(each) for each in misfits(case.scenario)]


def test_the_shipped_compensation_is_for_the_shipped_rig_and_one_that_lists_none_is_not_known_to_fit(case):
    differences = rig_differences(case().scenario)
    assert differences
    assert all(each.share == 0.0 for each in differences)
    scenario = case().scenario
    model = scenario.rig.compensation_model.model_copy(update={"identified_for": None})
    rig = scenario.rig.model_copy(update={"compensation_model": model})
    assert rig_differences(scenario.model_copy(update={"rig": rig})) is None


@pytest.mark.parametrize(
    ("override", "reason"),
    [
        ("rig.caliper.load_friction=15 %", "is 15 %, the compensation is for 7.5 % within 7.5 %"),
        ("rig.caliper.lever_ratio=3", "is 3, the compensation is for 2.45 within 0.5 %"),
        ("brake.system.tank.volume=4 L", "is 4 L, the compensation is for 2 L within 50 %"),
        ("brake.system.wsp_valve.travel_time=50 ms", "is 50 ms, the compensation is for 20 ms within 50 %"),
    ],
)
def test_a_number_beyond_its_tolerance_is_named_with_both_values(case, override, reason):
    assert told(case(override)) == [f"{override.partition('=')[0]} {reason}"]
    assert told(case(override, "rig.topology=four-caliper")) == []
    assert told(case(override, "rig.compensation_model=identify")) == []


def test_valves_count_where_a_module_has_no_caliper_and_once_where_they_differ_alike(case):
    [reason] = told(case("vehicle.wheelsets.3.wsp_valve.vent_conductance=9e-8 m3/(s Pa)"))
    assert reason.startswith("vehicle.wheelsets.3.wsp_valve.vent_conductance is 9e-8 m3/(s Pa), ")
    conductance = "vehicle.wheelsets.{}.wsp_valve.vent_conductance=3.5e-8 m3/(s Pa)"
    assert told(case(*(conductance.format(n) for n in (2, 3, 4)))) == []
    # No compensation stands in for that one.
    assert told(case("vehicle.wheelsets.1.wsp_valve.vent_conductance=9e-8 m3/(s Pa)")) == []


def test_numbers_within_their_tolerances_fit_but_not_in_sum(case):
    """Together they move a stop further than any of them does."""
    friction, volume = "rig.caliper.load_friction=8 %", "brake.system.tank.volume=2.9 L"
    assert told(case(friction)) == told(case(volume)) == []
    assert told(case(friction, volume)) == [
        "brake.system.tank.volume is 2.9 L, the compensation is for 2 L within 50 %",
        "rig.caliper.load_friction is 8 %, the compensation is for 7.5 % within 7.5 %",
    ]


@pytest.mark.parametrize(
    "override",
    [
        "rig.compensation_model.linear.slope=4.8 kN/bar",
        "rig.compensation_model.hysteresis.bc_releasing.slope=5 kN/bar",
        "rig.compensation_model.air.swept_volume=0.06 L",
        "rig.compensation_model.cylinder.denominator=[0, 0, 0]",
    ],
)
def test_a_compensation_whose_numbers_were_changed_is_not_known_to_fit(case, override):
    """It would keep the list of the rig that other numbers were identified for."""
    numerator = ["rig.compensation_model.cylinder.numerator=[1, 0, 0, 0]"] * ("cylinder" in override)
    assert rig_differences(case(override, *numerator).scenario) is None


def test_a_compensation_to_identify_has_tolerances_and_no_profile_takes_the_id_of_its_check(case, write):
    # It was an internal error, after minutes of identification.
    own = "schema: uictest/compensation/1\nname: own\nextends: identify\nidentified_for: null\n"
    write("own.yaml", own)
    with pytest.raises(ScenarioErrors, match="with `to_identify` has no `identified_for`"):
        case("rig.compensation_model=own.yaml")
    criterion = "{id: compensation-fits, layer: validity, measure: braking_distance, upper: 1 km}"
    write("own.yaml", f"schema: uictest/criteria/1\nname: own\ncriteria: [{criterion}]\n")
    with pytest.raises(ScenarioErrors, match="is in profile 'uictest-rig' as well"):
        case("criteria=own.yaml")
    assert [each.name for each in case("criteria=uictest-rig").scenario.judged_by] == ["uictest-rig"]
