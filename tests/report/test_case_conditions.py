"""What a case was run with: parts and their changes, controllers, train, and the validated domain."""

import dataclasses

import pytest

from uictest.judging.evaluation import (
    CouplerForces,
    Deviation,
    DomainOfValidity,
    EffectivePart,
    Parameter,
    result_document,
    results_of,
)
from uictest.judging.evaluation.result import CarInTrain
from uictest.report.case_conditions import (
    TRAIN_COLUMNS,
    changed_parameters,
    changes_line,
    controllers_text,
    deviation_text,
    domain_sentences,
    notices,
    part_sentences,
    slide_speed,
    train_facts,
)
from uictest.report.case_lines import part_lines
from uictest.report.content import run_manifest
from uictest.report.run_publication import cases_table

from .builders import make_content, make_result, make_verdict

SLIP = Parameter("controller.slip_threshold", 0.8, "m/s", "3 km/h", "user", "", True, 1.146, "1.146 m/s")
HOLD = Parameter("controller.hold_limit", 2.0, "s", "2 s", "chosen", "ours")
CONTROLLER = EffectivePart(
    "controller", "controller", "threshold", "threshold", (SLIP, HOLD), (), {"ours": "A surrogate."}
)
PLAIN = dataclasses.replace(CONTROLLER, parameters=(HOLD,))
OWN = dataclasses.replace(PLAIN, based_on=None)
BAND = dataclasses.replace(PLAIN, name="slip-band", based_on="slip-band")
COMPENSATION = EffectivePart("compensation", "rig.compensation_model", "six-inch", "six-inch", ())
CHANGE = "controller.slip_threshold 3 km/h (library: 1.146 m/s)"


def outside(name, **facts):
    """A controller from outside, with what its part states."""
    own = (Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
    return EffectivePart("controller", "controller", name, None, tuple(own))


LIBRARY = outside("wsp", library="wsp.so")
PROGRAM = outside(
    "Wsp",
    **{"parameters.gain": "2", "python": "wsp.py", "class": "Wsp", "version": "1.2.0", "sha256": "ab" * 32},
)
TOLD = "version 1.2.0, python wsp.py, SHA-256 abababababab"


def rig(topology="one-caliper", **settings):
    own = {"rig.topology": topology, "rig.compensation": "cylinder"} | {
        f"rig.{k}": v for k, v in settings.items()
    }
    return EffectivePart(
        "scenario.rig", "rig", "", None, tuple(Parameter(k, v, "", v, "user") for k, v in own.items())
    )


@pytest.mark.parametrize(
    ("parts", "told", "role", "sentence"),
    [
        ({"controller": CONTROLLER}, "", "controller",
         "threshold, changed: slip_threshold 3 km/h (library: 1.146 m/s)",),
        ({"controller": PLAIN}, "", "controller", "threshold"),
        # A user's part is not taken for the library's of the same name.
        ({"controller": OWN}, "", "controller", "threshold, own part"),
        ({"controller": PROGRAM}, "", "controller", f"Wsp, {TOLD}, with gain 2"),
        ({"controller": outside("tcp://rig:1", connect="tcp://rig:1")}, "", "controller",
         "tcp://rig:1, connect tcp://rig:1",),
        ({"controller": LIBRARY}, "1.3", "controller", "wsp, version 1.3, library wsp.so"),
        ({"controller": outside("wsp", library="wsp.so", version="1.1")}, "1.1", "controller",
         "wsp, version 1.1, library wsp.so",),
        ({"controller": outside("wsp", library="wsp.so", version="1.1")}, "", "controller",
         "wsp, version 1.1, library wsp.so",),
        ({"controller": outside("wsp", library="wsp.so", version="1.1")}, "1.2", "controller",
         "wsp, version 1.1 (the program says 1.2), library wsp.so",),
        ({"criteria.0": dataclasses.replace(OWN, kind="criteria", key="", name="uictest-stop")}, "",
         "criteria.0", "uictest-stop, own part",),
        ({"scenario.rig": rig(), "compensation": COMPENSATION}, "", "compensation",
         "six-inch, setting cylinder",),
        ({"scenario.rig": rig("four-caliper"), "compensation": COMPENSATION}, "", "compensation",
         "six-inch, not in use with four calipers",),
    ],
)  # fmt: skip
def test_a_part_is_named_with_what_was_changed_and_whose_it_is(parts, told, role, sentence):
    assert part_sentences(parts, told)[role] == sentence


def added(key, written, mark="user"):
    return Parameter(key, written, "", written, mark, "", differs=True)


ADDED = {"dynamic.force": "40 kN", "dynamic.wheelsets.0": "1", "dynamic.wheelsets.1": "2"}
ADDED |= {"command.0.at": "0 s", "command.0.value": "60 %"}
ADDED |= {"command.1.at": "8 s", "command.1.position": "emergency"}
BRAKE = [added(f"brake.{key}", text) for key, text in ADDED.items()]
BRAKE.append(added("brake.dynamic.response_time", "0.3 s", "default"))
POSITION = Parameter("brake.position", "G", "", "G", "user", "", True, "R", "R")
BRAKE = EffectivePart("scenario.brake", "brake", "", None, (*BRAKE, POSITION))
FAULT = {"at": "90 km/h", "until": "20 s", "wheelset": "1", "part": "speed-sensor", "kind": "factor"}
FAULT |= {"value": "90 %"}
FAULTS = EffectivePart(
    "scenario", "", "", None, tuple(added(f"faults.0.{key}", text) for key, text in FAULT.items())
)
MINE = dataclasses.replace(CONTROLLER, based_on="mine.yaml", removed=("controller.gone",))


@pytest.mark.parametrize(
    ("part", "varied", "changes"),
    [
        (PLAIN, [], []),
        (CONTROLLER, [], [CHANGE]),
        (CONTROLLER, [SLIP.key], []),
        # What a scenario adds stands as its file writes it, without defaults.
        (BRAKE, [], ["brake.dynamic {force: 40 kN, wheelsets: [1, 2]}",
         "brake.command [{at: 0 s, value: 60 %}, {at: 8 s, position: emergency}]",
         "brake.position G (default: R)",]),
        (EffectivePart("scenario", "", "", None, (added("sanders.0.wheelset", "1"),)), [],
         ["sanders [{wheelset: 1}]"]),
        # What a user's own file has instead is not called the library's.
        (MINE, [], ["controller threshold (own part based on mine.yaml)",
         "controller.slip_threshold 3 km/h (mine.yaml: 1.146 m/s)", "controller.gone removed",]),
        (PROGRAM, [], [f"controller Wsp ({TOLD}, with gain 2)"]),
        (PROGRAM, ["controller.parameters.gain"], [f"controller Wsp ({TOLD})"]),
        (OWN, [], ["controller threshold (own part)"]),
        (OWN, ["controller"], []),
        (dataclasses.replace(OWN, kind="criteria", key=""), [], []),
        (BAND, [], ["controller slip-band (default: threshold)"]),
        (BAND, ["controller"], []),
        (FAULTS, [], ["injected fault: speed sensor of wheelset 1: factor 90 % from 90 km/h until 20 s"]),
        (FAULTS, ["faults.0.at", "faults.0.until", "faults.0.wheelset"],
         ["injected fault: speed sensor: factor 90 %"]),
    ],
)  # fmt: skip
def test_what_differs_from_the_library_is_said_but_for_what_varies(part, varied, changes):
    assert changed_parameters({part.kind: part}, varied) == changes


def test_parts_are_listed_once_for_all_cases_alike_with_the_version_that_a_program_told():
    one, two = (
        make_result(id=name, parts={"controller": part})
        for name, part in (("one", CONTROLLER), ("two", PLAIN))
    )
    assert list(part_lines([one, one])) == [f"part controller: threshold, changed: {CHANGE[11:]}"]
    assert list(part_lines([one, two])) == [
        f"part controller (in one): threshold, changed: {CHANGE[11:]}",
        "part controller (in two): threshold",
    ]
    told = [
        make_result(id=version or "none", parts={"controller": LIBRARY}, controller_version=version)
        for version in ("1.2", "")
    ]
    assert list(part_lines(told)) == [
        "part controller (in 1.2): wsp, version 1.2, library wsp.so",
        "part controller (in none): wsp, library wsp.so",
    ]
    assert changes_line(told[0]) == ["changed parameters: controller wsp (version 1.2, library wsp.so)"]
    assert changes_line(two) == []
    content = run_manifest([], None, {}, 2, [one.parts, two.parts])
    assert content.parts == {CONTROLLER.id: f"threshold, changed: {CHANGE[11:]}", PLAIN.id: "threshold"}


def test_controllers_are_named_once_and_the_largest_slide_says_above_which_speed_it_counts():
    own, idle = ({"controller": PLAIN, "scenario.rig": part} for part in (rig(), rig(wsp="bypassed")))
    told = make_result(parts={"controller": LIBRARY}, controller_version="1.2", controller_contract=2)
    results = [make_result(parts=own), make_result(parts=idle), told, make_result(parts={})]
    built_in = "threshold (built into uictest 0.2.0)"
    assert controllers_text(results, "0.2.0") == f"{built_in}, wsp (version 1.2, contract 2)"
    # One that never acted is marked.
    assert controllers_text([make_result(parts=idle)], "0.2.0") == f"{built_in}, bypassed"
    speeds = [Parameter("measures.moving_speed", 1.0, "m/s", f"{n} km/h", "chosen") for n in (10, 5)]
    of_speeds = [EffectivePart("measures", "measures", "standard", "standard", (speed,)) for speed in speeds]
    ten, five = (make_result(parts={"measures": part}) for part in of_speeds)
    assert slide_speed([ten] * 2) == "10 km/h"
    assert slide_speed([ten, five]) == slide_speed([make_result()]) == "moving_speed"
    titles = [column.title for column, _ in cases_table(make_content(ten)).for_people]
    assert any("10 km/h" in title for title in titles)


PLACE = CarInTrain("ice", 2, 3, CouplerForces(17342.0, 250.0), CouplerForces(0.0, 12382.0))


def test_a_car_of_a_train_has_its_place_and_the_forces_in_its_couplers():
    car, alone = make_result(train=PLACE), make_result(id="alone")
    of_car, of_other = cases_table(make_content(car, alone)).records
    assert [of_car[name] for name in TRAIN_COLUMNS] == ["ice", 3, 17342.0, 250.0, 0.0, 12382.0]
    assert [of_other[name] for name in TRAIN_COLUMNS] == [None] * 6
    assert results_of(result_document([car]))[0].train == PLACE
    leading = make_result(train=CarInTrain("ice", 1, 3, None, PLACE.ahead))
    assert list(train_facts(leading)) == [
        ("place", "car 1 of 3 of ice"),
        ("coupler behind", "largest pull 17.3 kN, push 0.2 kN"),
    ]
    texts = {column.heading: texts for column, texts in cases_table(make_content(leading)).for_people}
    assert texts["train"] == ["car 1 of 3; coupler behind: pull 17.3 kN, push 0.2 kN"]
    # Without trains no table has their columns.
    table = cases_table(make_content(alone))
    assert not {column.key for column in table.columns} & set(TRAIN_COLUMNS)
    assert all(column.heading != "train" for column, _ in table.for_people)
    assert "train" not in result_document([alone])["cases"][0]


SPEED = Deviation("initial_speed", (160 / 3.6, 160 / 3.6), (80 / 3.6, 120 / 3.6), "m/s")


@pytest.mark.parametrize(
    ("deviation", "text"),
    [
        (SPEED, "initial_speed 160 km/h > 120 km/h"),
        (Deviation("rail.friction", (0.05, 0.05), (0.08, 0.12), "1"), "rail.friction 0.05 < 0.08"),
        (Deviation("f", (0.05, 0.3), (0.1, 0.2), "1"), "f 0.05 .. 0.3, validated 0.1 .. 0.2"),
        (Deviation("p", (1e5, 4e5), (3.8e5, 3.8e5), "Pa"), "p 1 .. 4 bar, validated 3.8 bar"),
        (Deviation("vehicle", "crh380a", "intercity-180"), "vehicle crh380a, validated intercity-180"),
        (Deviation("faults.0.kind", "stuck", None), "faults.0.kind stuck, validated not set"),
        (Deviation("faults.0.at", None, (3.0, 3.0), "s"), "faults.0.at not set, validated 3 s"),
    ],
)
def test_a_deviation_reads_in_the_units_of_engineers(deviation, text):
    assert deviation_text(deviation) == text


def beyond(*deviations):
    return make_result(id="stop", domain_of_validity=DomainOfValidity("my-train", "0" * 64, deviations))


def unrecorded(reason, layer="requirement"):
    lacking = {"value": None, "status": "not_applicable", "reason": reason, "lacks_data": reason == LACKING}
    return make_result(criteria=(make_verdict(id="energy", layer=layer, **lacking),))


LACKING = "not recorded: wheel_load_1 .. wheel_load_4"


@pytest.mark.parametrize(
    ("results", "said"),
    [
        ([make_result()], []),
        ([beyond()], ["0 of 1 case outside of what my-train validated"]),
        ([beyond(), beyond(SPEED)], ["1 of 2 cases outside of what my-train validated"]),
        ([unrecorded(LACKING), unrecorded(LACKING), unrecorded("for another rail")],
         [f"2 stops judged without energy, {LACKING}"]),
        ([unrecorded(LACKING, layer="rig")], []),
    ],
)  # fmt: skip
def test_a_run_says_how_many_cases_lie_outside_and_which_requirements_no_record_shows(results, said):
    assert list(notices(results)) == said


def test_many_deviations_of_a_case_are_counted():
    assert [*domain_sentences(beyond()), *domain_sentences(make_result())] == []
    [line] = domain_sentences(beyond(*[SPEED] * 9))
    assert line.startswith("outside of what my-train validated: initial_speed 160 km/h > 120 km/h; ")
    assert line.endswith("; 3 more in results.json")
