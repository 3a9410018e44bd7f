"""Each check rejects the controller that breaks its fact, and the controllers that ship pass fair limits."""

import json
from functools import partial
from xml.etree import ElementTree

import numpy as np
import pytest

from uictest import report, selftest
from uictest.controllers import OUTPUTS
from uictest.plans import templates
from uictest.plans.scenario import load_controller, load_part
from uictest.rig.external import workers
from uictest.selftest import conformance
from uictest.selftest.conformance import bench as situations, checks
from uictest.selftest.conformance.checks import recording_of

STEP = '        """Answer one controller cycle."""\n'
RESULT = "            hold=[hold for hold, _ in states],\n            vent=[vent for _, vent in states],\n"


@pytest.fixture
def here(monkeypatch):
    """Drive controllers in this process: they fail in none of their cycles."""
    monkeypatch.setattr(workers, "_is_isolated", lambda program: False)


@pytest.fixture
def examine(tmp_path, monkeypatch):
    """Examine the first controller in Python with one stretch of its text replaced by another.

    Its cycles take four times as long as those of the library, so that each drive has a quarter as many: as
    many cycles has the one with random inputs.
    """
    monkeypatch.setattr(situations, "anything", partial(situations.anything, cycles=750))

    def changed(before="", after="", time_limit="60 s"):
        files = templates.controller_files("python")
        assert before in files["my_wsp.py"]
        (tmp_path / "my_wsp.py").write_text(files["my_wsp.py"].replace(before, after, 1), "utf-8")
        part = tmp_path / "my-wsp.yaml"
        part.write_text(f"{files['my-wsp.yaml']}cycle_time: 40 ms\ntime_limit: {time_limit}\n", "utf-8")
        return conformance.examine(conformance.subject_of("changed", load_controller(str(part))))

    return changed


def missed(examination):
    """The checks that failed; how fast this machine is does not count."""
    return {each.id for each in examination.findings if each.status in ("fail", "error")}


def built_in(name):
    return conformance.examined(conformance.subject_of(name, load_part(f"controllers/{name}")))


@pytest.fixture(scope="module")
def slip_band():
    return built_in("slip-band")


def test_the_default_controller_conforms():
    assert missed(built_in("threshold").examination) == set()


def test_what_a_controller_answered_where_it_misses_a_check_is_a_recording_of_valves(slip_band):
    examined = slip_band
    assert examined.missed.keys() == {"ends-vents", "lost-sensor"}
    locked = examined.missed["ends-vents"]["wheelset 2 locked"]
    recording = recording_of(locked)
    longest = np.count_nonzero(recording["valve_command_2"] == 2.0)
    assert longest == np.count_nonzero(locked.vent[:, 1])
    assert recording["wheel_speed_2"][-1] == 0.0
    locked.hold[:, 1] = 7  # no command that a valve has
    assert np.isnan(recording_of(locked)["valve_command_2"]).all()


def test_the_simplest_controller_has_no_watchdog(slip_band):
    examination = slip_band.examination
    assert missed(examination) == {"ends-vents", "lost-sensor"}
    assert examination.status == "fail"


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        (RESULT, "hold=[0] * 4, vent=[vent for _, vent in states],\n", {"legal-commands"}),
        (
            "= self.initial_speed\n",
            "= getattr(self, 'reference_speed', self.initial_speed)\n",
            {"same-after-reset"},
        ),
        ("slide < self.lower_slide", "slide < -1e-4", {"keeps-brake", "gives-back"}),
        ("slide < self.upper_slide", "slide < 2.0", {"vents-sliding"}),
        (
            RESULT,
            "hold=[any(h for h, _ in states)] * 4, vent=[any(v for _, v in states)] * 4,\n",
            {"spares-rolling"},
        ),
        ("return False, False  # fill", "return self.reference_speed < 25.0, False", {"gives-back"}),
        ("not filling, not filling", "True, True", {"ends-vents"}),
        (
            "reference_speed=self.reference_speed",
            "reference_speed=1.2 * self.reference_speed",
            {"reference-speed"},
        ),
    ],
    ids=lambda value: value if isinstance(value, str) else "-".join(sorted(value)),
)
def test_a_controller_that_breaks_a_fact_is_found(examine, before, after, expected):
    examination = examine(before, after)
    assert expected <= missed(examination)
    assert examination.status == "fail"


@pytest.mark.usefixtures("here")
def test_a_controller_of_version_2_that_reduces_no_motor_is_found(examine):
    examination = examine("class MyWsp:\n", "class MyWsp:\n    contract = 2\n\n")
    assert missed(examination) == {"motor-first"}
    assert "motor-first" not in {each.id for each in examine().findings}


def test_memory_that_controllers_share_is_found(examine):
    """A second controller must not begin where the first one is."""
    examination = examine("        self.reference_speed = self.initial_speed\n", SHARED)
    [finding] = [each for each in examination.findings if each.id == "same-after-reset"]
    assert finding.status == "fail"
    assert finding.reason.startswith("after reset 0 cycles differ, with a second controller ")


def test_what_is_learnt_for_good_is_found_also_by_situations_that_come_first(examine):
    """A reset that forgets to clear it: nothing differs any more once all has been learnt."""
    examination = examine("        self.reference_speed = self.initial_speed\n", LEARNT)
    [finding] = [each for each in examination.findings if each.id == "same-after-reset"]
    assert finding.status == "fail"


LEARNT = """\
        self.reference_speed = 0.0 if hasattr(MyWsp, "learnt") else self.initial_speed
        MyWsp.learnt = True
"""
SHARED = """\
        if not hasattr(self, "number"):
            type(self).created = getattr(type(self), "created", 0) + 1
            self.number = self.created
        self.reference_speed = self.initial_speed if self.number % 2 else 0.0
"""


@pytest.mark.usefixtures("here")
def test_memory_that_a_reset_empties_is_found_where_two_controllers_work_in_turn(examine):
    """As in a block of a sweep or in the cars of a train."""
    examination = examine("    def reset(self)", EMPTIED)
    assert "same-beside-another" in missed(examination)
    assert "same-after-reset" not in missed(examination)


EMPTIED = """\
    @property
    def reference_speed(self):
        return MyWsp.estimate

    @reference_speed.setter
    def reference_speed(self, value):
        MyWsp.estimate = value

    def reset(self)"""


def test_only_fields_of_answers_are_compared():
    """A controller in C that assigns the whole structure leaves anything behind them."""
    one, other = np.zeros((2, 5), OUTPUTS)
    other["padding"] = 7
    assert len(checks._cycles_that_differ(one, other)) == 0
    other["hold"][3, 1] = 1
    assert checks._cycles_that_differ(one, other).tolist() == [3]


@pytest.mark.usefixtures("here")
def test_a_controller_without_a_reference_speed_is_not_judged_by_it(examine):
    examination = examine("            reference_speed=self.reference_speed,\n", "")
    [finding] = [each for each in examination.findings if each.id == "reference-speed"]
    assert (finding.status, finding.found) == ("skipped", None)
    assert missed(examination) == set()


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("raise ValueError('no wheel')", "ValueError: no wheel (my_wsp.py, line "),
        ("import os; os.kill(os.getpid(), 11)", "crashed with SIGSEGV"),
        ("import time; time.sleep(600)", "step did not return within 0.5 s"),
        ("return None", "step returned NoneType, expected Outputs"),
    ],
)
def test_a_controller_that_fails_is_an_error_with_the_cycle(examine, fault, message):
    """In one situation alone: the checks that do not need it are decided all the same."""
    sudden = f"{STEP}        if inputs.brake_demand < 0.2: {fault}\n"
    examination = examine(STEP, sudden, time_limit="500 ms" if "sleep" in fault else "60 s")
    assert examination.status == "error"
    by_id = {each.id: each for each in examination.findings}
    assert message in by_id["same-after-reset"].reason
    assert "(cycle " in by_id["same-after-reset"].reason
    assert by_id["keeps-brake"].status == "pass"


def test_a_controller_that_cannot_do_without_a_speed_is_an_error(examine):
    """Where all sensors report a fault at once, as with a common supply."""
    needs = "        max(each for each, valid in zip(inputs.wheel_speed, inputs.speed_valid) if valid)\n"
    by_id = {each.id: each for each in examine(STEP, f"{STEP}{needs}").findings}
    assert "step failed: ValueError: max() " in by_id["legal-commands"].reason
    assert by_id["lost-sensor"].status == "pass"


def test_a_controller_that_cannot_be_created_is_an_error(examine):
    examination = examine('parameters["pause"]', 'parameters["paus"]')
    assert {each.status for each in examination.findings} == {"error"}
    assert "KeyError: 'paus'" in examination.findings[0].reason


def test_the_report_has_every_check_in_each_form(examine):
    examination = examine("slide < self.upper_slide", "slide < 2.0")
    table = list(report.document_lines(selftest.finding_document(examination), None))
    assert table[-2].startswith("fail vents-sliding: ")
    document = json.loads(selftest.findings_json(examination))
    of_version_1 = [each.id for each in conformance.CHECKS if each.contract == 1]
    assert [each["id"] for each in document["checks"]] == of_version_1
    assert document["about"]["controller.version"] == "0.1.0"
    suite = ElementTree.fromstring(report.junit_text([selftest.findings_suite(examination)]))[0]
    assert suite.get("tests") == str(len(of_version_1))
    [failure] = suite.findall("testcase/failure")
    assert "expected at most 1, found never s" in (failure.text or "")
