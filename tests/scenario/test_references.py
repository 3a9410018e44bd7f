"""References to parts: names, paths, inline mappings."""

import pytest

from uictest.plans.scenario import ScenarioErrors, load


def test_everything_left_out_is_the_librarys_default(loaded, head):
    (case,) = loaded(head)
    scenario = case.scenario
    names = (
        scenario.vehicle.name,
        scenario.brake.system.name,
        scenario.rail.condition.name,
        scenario.rig.caliper.name,
        scenario.rig.compensation_model.name,
        scenario.rig.sensors.name,
        scenario.controller.name,
        *(each.name for each in scenario.criteria),
    )
    assert names == (
        *("intercity-180", "ep-disc", "dry", "six-inch", "six-inch", "standard", "threshold", "uictest-stop"),
    )
    assert "library:vehicles/intercity-180.yaml" in case.inputs
    assert all(len(digest) == 64 for digest in case.inputs.values())


def test_an_inline_mapping_overrides_only_what_it_names_and_several_criteria_keep_their_order(loaded, head):
    (case,) = loaded(head + "vehicle: {extends: crh380a, body: {mass: 40 t}}\n")
    body = case.scenario.vehicle.body
    assert (body.mass, body.mass.source) == (40_000.0, "scenario")
    assert (body.pitch_inertia, body.pitch_inertia.source) == (1.654e6, "crh380a")
    assert "library:vehicles/crh380a.yaml" in case.inputs
    (case,) = loaded(head + "controller: {extends: slip-band, upper_slide: 30 %}\n")
    assert case.scenario.controller.algorithm == "slip-band"
    assert case.scenario.controller.upper_slide == 0.3
    (case,) = loaded(head + "criteria: [uictest-stop, uic-541-05-appendix-b]\n")
    assert [each.name for each in case.scenario.criteria] == ["uictest-stop", "uic-541-05-appendix-b"]


def test_a_part_is_based_on_the_library_part_at_the_root_of_its_extends_on_a_file_or_on_nothing(
    loaded, write, head
):
    write("mine.yaml", "schema: uictest/controller/1\nname: mine\nextends: threshold\nhold_limit: 3 s\n")
    (case,) = loaded(head + "controller: {extends: mine.yaml, slip_threshold: 3 km/h}\n")
    controller = case.scenario.controller
    assert (controller.name, controller.based_on) == ("mine", "threshold")
    for each in (controller, controller.model_copy(update={"hold_limit": 9.0})):
        assert (each.original.slip_threshold, each.original.hold_limit) == (0.9993, 2.0)
    own = "algorithm: slip-band, cycle_time: 10 ms, reference_deceleration: 2 m/s2, minimum_speed: 5 km/h"
    write("parts/own.yaml", "{schema: uictest/controller/1, name: own, " + own + ", upper_slide: 20 %}")
    (case,) = loaded(head + "controller: {extends: parts/own.yaml, lower_slide: 8 %}\n")
    (inline,) = loaded(head + "controller: {" + own + ", lower_slide: 8 %, upper_slide: 20 %}\n")
    assert (case.scenario.controller.based_on, case.scenario.controller.original) == ("own.yaml", None)
    assert (inline.scenario.controller.based_on, inline.scenario.controller.original) == (None, None)
    (named,) = loaded(head + "rail: {condition: wet-cleaning}\nbrake: {system: distributor}\n")
    assert named.scenario.rail.condition.based_on == "wet-cleaning"
    assert named.scenario.rail.condition.original.cleaning is not None
    (changed,) = loaded(head + "rail: {condition: {extends: wet-cleaning, friction: 0.1}}\n")
    assert changed.scenario.rail.condition.based_on == "wet-cleaning"
    assert changed.scenario.rail.condition.original.friction == 0.3
    assert changed.scenario.rail.condition.original.cleaning is not None


def test_the_errors_of_all_references_are_told_and_two_profiles_have_no_criteria_of_one_name(
    refused, head, write
):
    diagnostics = refused(head + "vehicle: a\ncontroller: b\ncriteria: [c, d]\n")
    assert [each.key for each in diagnostics] == ["vehicle", "controller", "criteria.0", "criteria.1"]
    write("a.yaml", f"schema: uictest/criteria/1\nname: a\ncriteria: [{CRITERION}]\n")
    (by_name,) = refused(f"{head}criteria:\n- a.yaml\n- uictest-stop\n- a.yaml\n")
    assert (by_name.line, by_name.column, by_name.key) == (7, 3, "criteria.2.criteria.0.id")
    assert by_name.message == "criterion 'same' of profile 'a' is in profile 'a' as well"
    (inline,) = refused(f"{head}criteria:\n- a.yaml\n- {{name: b, criteria: [{CRITERION}]}}\n")
    assert (inline.line, inline.message) == (6, "criterion 'same' of profile 'b' is in profile 'a' as well")


def test_an_error_in_a_part_file_points_into_it_and_another_kind_is_refused(write, head):
    write("car.yaml", "schema: uictest/vehicle/1\nextends: crh380a\nbody: {mass: 40}\n")
    with pytest.raises(ScenarioErrors) as caught:
        load([write("stop.yaml", head + "vehicle: car.yaml\n")])
    (diagnostic,) = caught.value.diagnostics
    place = (diagnostic.file, diagnostic.line, diagnostic.column)
    assert (*place, diagnostic.key) == ("car.yaml", 3, 14, "body.mass")
    write("rail.yaml", "schema: uictest/rail/1\nextends: wet\n")
    with pytest.raises(ScenarioErrors, match="expected uictest/vehicle/1, found 'uictest/rail/1'"):
        load([write("stop.yaml", head + "vehicle: rail.yaml\n")])


CRITERION = "{id: same, layer: validity, measure: standstill, lower: 1}"


def test_a_part_may_add_sources_of_its_own_and_give_inherited_numbers_no_other(head, loaded):
    sources = "sources: {bench: {mark: chosen, text: Bench test}}"
    (case,) = loaded(
        head + f"controller: {{extends: threshold, {sources}, hold_limit: {{value: 3 s, source: bench}}}}\n"
    )
    assert case.scenario.controller.sources["bench"].text == "Bench test"
    assert case.scenario.controller.sources["chosen"].mark == "chosen"
    sources = "sources: {chosen: {mark: published, text: Some other paper}}"
    with pytest.raises(ScenarioErrors, match="source 'chosen' describes numbers of the part") as rejected:
        loaded(head + f"controller: {{extends: threshold, {sources}}}\n")
    assert "sources.chosen" in str(rejected.value)
