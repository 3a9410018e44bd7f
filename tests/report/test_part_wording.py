"""What a case was run with, in every format that says so."""

import csv
import dataclasses
import io
from xml.etree import ElementTree

import pytest

from uictest.judging.evaluation import EffectivePart, Parameter
from uictest.report import (
    case_annotations,
    csv_text,
    junit_text,
    part_lines,
    run_manifest,
    run_suites,
)
from uictest.report.formats.csv import FORMAT as CSV, summary_table
from uictest.report.formats.junit import FORMAT as JUNIT
from uictest.report.formats.md import FORMAT as MARKDOWN, markdown_summary
from uictest.report.page import page_html, sweep_page_html
from uictest.report.page.overview import shown_parts
from uictest.report.part_wording import changed_parameters, controllers_text, part_sentences, slide_speed

from .builders import make_content, make_result

SLIP = Parameter("controller.slip_threshold", 0.8, "m/s", "3 km/h", "user", "", True, 1.146, "1.146 m/s")
HOLD = Parameter("controller.hold_limit", 2.0, "s", "2 s", "chosen", "ours")
CONTROLLER = EffectivePart(
    "controller", "controller", "threshold", "threshold", (SLIP, HOLD), (), {"ours": "A surrogate."}
)
PLAIN = dataclasses.replace(CONTROLLER, parameters=(HOLD,))
COMPENSATION = EffectivePart("compensation", "rig.compensation_model", "six-inch", "six-inch", ())
CHANGE = "controller.slip_threshold 3 km/h (library: 1.146 m/s)"


def rig(topology, compensation="full"):
    settings = {"rig.topology": topology, "rig.compensation": compensation}
    own = tuple(Parameter(key, text, "", text, "user") for key, text in settings.items())
    return EffectivePart("scenario.rig", "rig", "", None, own)


def test_a_changed_part_is_named_with_what_was_changed():
    assert part_sentences({"controller": CONTROLLER}) == {
        "controller": "threshold, changed: slip_threshold 3 km/h (library: 1.146 m/s)"
    }
    assert part_sentences({"controller": PLAIN}) == {"controller": "threshold"}


def added(key, written, mark="user"):
    return Parameter(key, written, "", written, mark, "", differs=True)


def test_what_a_scenario_adds_stands_as_its_file_writes_it_without_defaults():
    brake = EffectivePart(
        *("scenario.brake", "brake", "", None),
        (
            added("brake.dynamic.force", "40 kN"),
            added("brake.dynamic.wheelsets.0", "1"),
            added("brake.dynamic.wheelsets.1", "2"),
            added("brake.dynamic.response_time", "0.3 s", "default"),
            added("brake.command.0.at", "0 s"),
            added("brake.command.0.value", "60 %"),
            added("brake.command.1.at", "8 s"),
            added("brake.command.1.position", "emergency"),
            Parameter("brake.position", "G", "", "G", "user", "", True, "R", "R"),
        ),
    )
    assert changed_parameters({"scenario.brake": brake}) == [
        "brake.dynamic {force: 40 kN, wheelsets: [1, 2]}",
        "brake.command [{at: 0 s, value: 60 %}, {at: 8 s, position: emergency}]",
        "brake.position G (default: R)",
    ]
    sanders = EffectivePart("scenario", "", "", None, (added("sanders.0.wheelset", "1"),))
    assert changed_parameters({"scenario": sanders}) == ["sanders [{wheelset: 1}]"]


def test_a_page_tells_sections_of_scenarios_apart_and_keeps_those_of_a_kind_together():
    first, second = (
        EffectivePart("scenario.rail", "rail", "", None, (added("rail.friction", value),))
        for value in ("0.03", "0.08")
    )
    shown = shown_parts([{"rail": first, "controller": PLAIN}, {"rail": second}])
    assert shown.parts == [first, second, PLAIN]
    content = make_content(*(make_result(id=each.id, parts={"rail": each}) for each in (first, second)))
    headings = [line for line in page_html(content).splitlines() if "<summary>scenario.rail" in line]
    assert ["0.03" in line for line in headings] == [True, False]


def test_what_a_users_own_file_has_instead_is_not_called_the_librarys():
    own = dataclasses.replace(CONTROLLER, based_on="mine.yaml", removed=("controller.gone",))
    assert changed_parameters({"controller": own}) == [
        "controller threshold (own part based on mine.yaml)",
        "controller.slip_threshold 3 km/h (mine.yaml: 1.146 m/s)",
        "controller.gone removed",
    ]


def test_a_controller_from_outside_is_told_by_its_program():
    facts = {
        "parameters.gain": "2",
        "python": "wsp.py",
        "class": "Wsp",
        "version": "1.2.0",
        "sha256": "ab" * 32,
    }
    parameters = (Parameter(f"controller.{key}", text, "", text, "user") for key, text in facts.items())
    part = EffectivePart("controller", "controller", "Wsp", None, tuple(parameters))
    told = "version 1.2.0, python wsp.py, SHA-256 abababababab"
    assert part_sentences({"controller": part}) == {"controller": f"Wsp, {told}, with gain 2"}
    assert changed_parameters({"controller": part}) == [f"controller Wsp ({told}, with gain 2)"]
    varied = ["controller.parameters.gain"]
    assert changed_parameters({"controller": part}, varied) == [f"controller Wsp ({told})"]
    at_socket = dataclasses.replace(
        part, name="tcp://rig:1", parameters=(Parameter("controller.connect", "tcp://rig:1", "", "", "user"),)
    )
    assert part_sentences({"controller": at_socket}) == {"controller": "tcp://rig:1, connect tcp://rig:1"}


LIBRARY = EffectivePart(
    "controller",
    "controller",
    "wsp",
    None,
    (Parameter("controller.library", "wsp.so", "", "wsp.so", "user"),),
)


def test_the_version_that_a_controller_tells_is_shown_case_by_case():
    parts = {"controller": LIBRARY}
    told = [("one", "1.2"), ("two", "1.3"), ("failed", "")]
    results = [make_result(id=name, parts=parts, controller_version=text) for name, text in told]
    assert list(part_lines(results)) == [
        "part controller (in one): wsp, version 1.2, library wsp.so",
        "part controller (in two): wsp, version 1.3, library wsp.so",
        "part controller (in failed): wsp, library wsp.so",
    ]
    (suite,) = ElementTree.fromstring(junit_text(run_suites(results))).iter("testsuite")
    properties = {each.get("name"): each.get("value") for each in suite.iter("property")}
    assert properties["controller.version"] == "1.2, 1.3"
    assert [each.text.splitlines()[0] for each in suite.iter("system-out")] == [
        "changed parameters: controller wsp (version 1.2, library wsp.so)",
        "changed parameters: controller wsp (version 1.3, library wsp.so)",
        "changed parameters: controller wsp (library wsp.so)",
    ]


def test_a_version_that_contradicts_the_stated_one_stands_beside_it():
    version = Parameter("controller.version", "1.1", "", "1.1", "user")
    stated = dataclasses.replace(LIBRARY, parameters=(*LIBRARY.parameters, version))
    for told, sentence in {"1.1": "version 1.1", "": "version 1.1"}.items():
        assert part_sentences({"controller": stated}, told) == {
            "controller": f"wsp, {sentence}, library wsp.so"
        }
    assert part_sentences({"controller": stated}, "1.2") == {
        "controller": "wsp, version 1.1 (the program says 1.2), library wsp.so"
    }


def test_a_users_part_is_not_taken_for_the_librarys_of_the_same_name():
    own = dataclasses.replace(PLAIN, based_on=None)
    assert part_sentences({"controller": own}) == {"controller": "threshold, own part"}
    assert changed_parameters({"controller": own}) == ["controller threshold (own part)"]
    assert not changed_parameters({"controller": own}, ["controller"])

    profile = dataclasses.replace(own, kind="criteria", key="", name="uictest-stop")
    assert part_sentences({"criteria.0": profile}) == {"criteria.0": "uictest-stop, own part"}
    assert not changed_parameters({"criteria.0": profile})


@pytest.mark.parametrize(
    ("topology", "sentence"),
    [
        ("one-caliper", "six-inch, setting cylinder"),
        ("four-caliper", "six-inch, not in use with four calipers"),
    ],
)
def test_the_compensation_is_named_with_its_setting(topology, sentence):
    parts = {"scenario.rig": rig(topology, "cylinder"), "compensation": COMPENSATION}
    assert part_sentences(parts)["compensation"] == sentence


def test_parts_are_listed_once_for_all_cases_alike():
    one, two = make_result(id="one", parts={"controller": CONTROLLER}), make_result(id="two")
    two = dataclasses.replace(two, parts={"controller": PLAIN})
    assert list(part_lines([one, one])) == [f"part controller: threshold, changed: {CHANGE[11:]}"]
    assert list(part_lines([one, two])) == [
        f"part controller (in one): threshold, changed: {CHANGE[11:]}",
        "part controller (in two): threshold",
    ]


def test_tables_and_summaries_say_what_was_changed():
    result = make_result(parts={"controller": CONTROLLER}, expect="fail")
    (row,) = csv.DictReader(io.StringIO(csv_text(*summary_table([result]))))
    assert row["changed_parameters"] == CHANGE
    assert "3 km/h" in markdown_summary(make_content(result))
    assert CHANGE in "".join(case_annotations(result))


def test_junit_says_it_of_a_case_that_is_met_and_of_one_that_is_not():
    parts = {"controller": CONTROLLER}
    met, missed = ElementTree.fromstring(
        junit_text(run_suites([make_result(parts=parts), make_result(parts=parts, expect="fail")]))
    ).iter("testcase")
    assert met.findtext("system-out").splitlines()[0] == f"changed parameters: {CHANGE}"
    assert (missed.findtext("failure") or "").endswith(f"changed parameters: {CHANGE}")


def test_the_page_shows_the_change_beside_the_verdict_and_all_parameters_once():
    results = [make_result(id=name, parts={"controller": CONTROLLER}) for name in ("one", "two")]
    html = page_html(make_content(*results))
    assert html.count(f"changed: {CHANGE}") == 2
    assert html.count(f'id="{CONTROLLER.id}"') == 1
    assert html.count("controller.hold_limit") == 1
    assert "A surrogate." in html


def test_the_page_of_a_sweep_says_what_is_changed_in_every_case_and_what_varies(make_sweep):

    def of_varied(key):
        content = make_sweep(varied=[key])
        result = dataclasses.replace(content.result, base={"controller": CONTROLLER})
        return dataclasses.replace(content, result=result)

    steady = of_varied("rail.friction")
    assert f"changed in every case: {CHANGE}" in sweep_page_html(steady)
    assert f"changed in every case of car 1: {CHANGE}" in sweep_page_html(of_varied("car"))
    swept = of_varied(SLIP.key)
    html = sweep_page_html(swept)
    assert "changed in every case" not in html
    assert "3 km/h <small>varied</small>" in html


def test_the_manifest_names_the_parts_with_their_digests():
    content = run_manifest([], None, {}, 2, [{"controller": CONTROLLER}, {"controller": PLAIN}])
    assert content.parts == {
        CONTROLLER.id: f"threshold, changed: {CHANGE[11:]}",
        PLAIN.id: "threshold",
    }


def test_a_page_of_many_parts_says_how_many_it_leaves_out_and_where_they_are():
    parts = [dataclasses.replace(PLAIN, name=f"own-{k}") for k in range(102)]
    html = page_html(make_content(*(make_result(id=each.name, parts={"controller": each}) for each in parts)))
    assert sum(f'id="{each.id}"' in html for each in parts) == 100
    assert "2 more parts not shown here: results.json has all of them." in html
    few = page_html(make_content(make_result(parts={"controller": PLAIN})))
    assert "not shown here" not in few


def test_a_stop_links_to_the_parts_that_the_page_shows_and_to_no_other():
    shown = shown_parts([{"controller": CONTROLLER}])
    assert CONTROLLER in shown
    assert PLAIN not in shown


BAND = dataclasses.replace(PLAIN, name="slip-band", based_on="slip-band")


def test_a_controller_of_the_library_that_is_not_the_default_is_a_change():
    parts = {"scenario.rig": rig("one-caliper"), "controller": BAND}
    assert changed_parameters(parts) == ["controller slip-band (default: threshold)"]
    assert not changed_parameters(parts, ["controller"])
    assert not changed_parameters({"controller": PLAIN})


def test_every_report_names_the_controller_under_test_and_its_version():
    parts = {"controller": BAND}
    content = make_content(make_result(parts=parts, outcome="fail"))
    headline = "slip-band (built into uictest 0.1.0)"
    files = JUNIT.files(content) | CSV.files(content) | MARKDOWN.files(content)
    suite = ElementTree.fromstring(files["junit.xml"])[0]
    properties = {each.get("name"): each.get("value") for each in suite.iter("property")}
    assert properties == {"controller": "slip-band", "controller.version": "uictest 0.1.0"}
    assert f"controller: {headline}" in str(suite.findtext("testcase/failure"))
    (row,) = csv.DictReader(io.StringIO(files["summary.csv"].decode()))
    assert (row["controller"], row["controller_version"]) == ("slip-band", "uictest 0.1.0")
    assert f"WSP controller: {headline}." in files["summary.md"].decode()
    assert f"WSP controller: <strong>{headline}</strong>" in page_html(content)


def test_the_page_names_every_vehicle_once():
    cars = [EffectivePart("vehicle", "vehicle", name, name, ()) for name in ("wagon", "coach", "wagon")]
    results = [
        make_result(id=str(k), parts={"controller": PLAIN, "vehicle": car}) for k, car in enumerate(cars)
    ]
    assert "vehicle: <strong>wagon, coach</strong>" in page_html(make_content(*results))


def test_controllers_are_named_once_and_one_that_never_acted_is_marked():
    bypassed = EffectivePart(
        "scenario.rig", "rig", "", None, (Parameter("rig.wsp", "bypassed", "", "bypassed", "user"),)
    )
    own, idle = ({"controller": PLAIN, "scenario.rig": each} for each in (rig("one-caliper"), bypassed))
    outside = make_result(parts={"controller": LIBRARY}, controller_version="1.2", controller_contract=2)
    both = [make_result(parts=own), make_result(parts=idle), outside, make_result(parts={})]
    assert (
        controllers_text(both, "0.2.0")
        == "threshold (built into uictest 0.2.0), wsp (version 1.2, contract 2)"
    )
    assert (
        controllers_text([make_result(parts=idle)], "0.2.0")
        == "threshold (built into uictest 0.2.0), bypassed"
    )


def test_the_largest_slide_says_above_which_speed_it_counts():
    moving = Parameter("measures.moving_speed", 2.78, "m/s", "10 km/h", "chosen")
    parts = {"measures": EffectivePart("measures", "measures", "standard", "standard", (moving,))}
    other = {
        "measures": dataclasses.replace(
            parts["measures"], parameters=(dataclasses.replace(moving, written="5 km/h"),)
        )
    }
    assert slide_speed([make_result(parts=parts)] * 2) == "10 km/h"
    assert slide_speed([make_result(parts=parts), make_result(parts=other)]) == "moving_speed"
    content = make_content(make_result(parts=parts))
    assert "largest slide, above 10 km/h, %" in markdown_summary(content)
    assert "Largest slide<small>above 10 km/h, %</small>" in page_html(content)
