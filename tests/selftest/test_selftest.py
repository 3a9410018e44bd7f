"""The known answers hold here, and what is not as it should be is found."""

import base64
import builtins
import functools
import hashlib
import json
import math
import operator
import shutil
from importlib.metadata import Distribution
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st

import uictest
from uictest import selftest
from uictest.core import physics, user_cache
from uictest.selftest import examination, known_stops
from uictest.selftest.known_stops import Answer, Check, NotCheckedError, answer_of, data_digests

STORED = json.loads(selftest.REFERENCE.read_text("utf-8"))
NUMBERS = {
    f"{stop}.{name}": text
    for stop, of_stop in STORED["stops"].items()
    for name, text in of_stop["numbers"].items()
}
FINITE = sorted(name for name, text in NUMBERS.items() if " " not in text and math.isfinite(float(text)))


@pytest.fixture(scope="session")
def stops():
    """The known stops, each simulated once."""
    return selftest.KnownStops()


def status_of(stops, check_id):
    """Ask one question and return what came of it."""
    check = next(each for each in selftest.all_checks(stops) if each.id == check_id)
    return selftest.examine(stops, [check]).findings[0].status


def test_every_known_answer_holds_in_this_installation(stops):
    examination = selftest.examine(stops)
    assert {each.id: each.reason for each in examination.findings if each.status in ("fail", "error")} == {}
    assert len({each.id for each in examination.findings}) == len(examination.findings)


def test_a_known_answer_says_where_it_comes_from(stops):
    origins = {each.id: each.origin for each in selftest.all_checks(stops)}
    assert origins["creep-on-wet-rail"] == "publication"
    assert origins["textbook-stop"] == "closed form of the rig's own force"


def _compensated_sum(values, /, start=0):
    """Return the sum as Python 3.12 and later give it: without the rounding of each addition."""
    listed = [start, *values]
    floats = any(isinstance(each, float) for each in listed)
    return math.fsum(listed) if floats else functools.reduce(operator.add, listed)


@pytest.mark.parametrize("python_sum", [sum, _compensated_sum])
def test_the_stored_numbers_are_those_of_this_tree_however_python_adds(monkeypatch, python_sum):
    """Where a change is meant to change results: python scripts/selftest_reference.py."""
    monkeypatch.setattr(builtins, "sum", python_sum)
    computed = json.loads(selftest.computed_reference())
    assert {**computed, "version": STORED["version"]} == STORED


@given(st.sampled_from(FINITE), st.sampled_from([-math.inf, math.inf]))
def test_a_changed_bit_of_any_number_is_found_and_named(name, towards):
    changed = {**NUMBERS, name: repr(float(np.nextafter(float(NUMBERS[name]), towards)))}
    answer = answer_of(NUMBERS, changed)
    assert answer.expected != answer.found
    assert answer.words.startswith(f"1 of {len(NUMBERS)} numbers differ: {name}: expected {NUMBERS[name]}")


def test_a_number_that_is_missing_or_new_is_found():
    fewer = dict(list(NUMBERS.items())[1:])
    for answer in (answer_of(NUMBERS, fewer), answer_of(fewer, NUMBERS)):
        assert answer.expected != answer.found
        assert "no such number" in answer.words


def test_a_changed_bit_of_the_rig_fails_its_stop_and_the_lanes(stops, monkeypatch):
    stored = dict(known_stops._stored_reference()["stops"]["dry-120"]["numbers"])
    distance = float(stored["braking_distance"])
    stored["braking_distance"] = repr(float(np.nextafter(distance, 0.0)))
    content = {
        **STORED,
        "stops": {**STORED["stops"], "dry-120": {**STORED["stops"]["dry-120"], "numbers": stored}},
    }
    monkeypatch.setattr(known_stops, "_stored_reference", lambda: content)
    failed = [each for each in selftest.examine(stops).findings if each.status == "fail"]
    assert [each.id for each in failed] == ["dry-120", "lanes"]
    assert all("1 of " in each.reason and "braking_distance" in each.reason for each in failed)


def test_a_changed_part_of_the_library_is_found_in_the_inputs(stops, monkeypatch):
    changed = stops.cases["dry-120"]
    heavier = changed.scenario.model_copy(update={"seed": 1})
    monkeypatch.setitem(stops.cases, "dry-120", type(changed)(changed.id, heavier, changed.path, {}, {}))
    assert status_of(stops, "inputs-of-dry-120") == "fail"


def scaled(function):
    """Let a function return one per cent more."""

    def more(*arguments, **named):
        result = function(*arguments, **named)
        return tuple(1.01 * each for each in result) if isinstance(result, tuple) else 1.01 * result

    return more


BROKEN = {
    "adiabatic-tank": "enthalpy",
    "isothermal-tank": "mass_flow",
    "choked-orifice": "mass_flow",
    "creep-without-reduction": "creep_force",
    "creep-on-wet-rail": "creep_force",
    "highest-creep": "creep_force",
    "play-loop": "force_after",
    "caliper-loop": "stroke_after",
}
"""Check -> the function of physics without which it must fail."""


@pytest.mark.parametrize("check_id", BROKEN)
def test_physics_that_is_wrong_by_one_per_cent_is_found(stops, monkeypatch, check_id):
    function = BROKEN[check_id]
    monkeypatch.setattr(physics, function, scaled(getattr(physics, function)))
    assert status_of(stops, check_id) == "fail"


def test_a_stop_that_is_wrong_by_one_per_cent_misses_the_textbook(stops, monkeypatch):
    stop = stops.stop("rolling-120")
    measures = stop.measures.copy()
    measures["braking_distance"] *= 1.01
    monkeypatch.setattr(stops, "stop", lambda name: type(stop)(measures, stop.wheelset_measures))
    assert status_of(stops, "textbook-stop") == "fail"


def asked(stops, answer, **options):
    """Ask one question that is made up."""
    return selftest.examine(stops, [Check("made-up", "physics", "made up", answer, **options)]).findings[0]


def test_what_a_machine_lacks_is_skipped_and_says_why(stops):
    def lacking(stops):
        raise NotCheckedError("no C compiler")

    finding = asked(stops, lacking)
    assert (finding.status, finding.reason) == ("skipped", "no C compiler")


def test_a_check_that_raises_is_an_error(stops):
    finding = asked(stops, lambda stops: Answer(1.0, 1.0 / 0.0))
    assert (finding.status, finding.reason) == ("error", "ZeroDivisionError: float division by zero")


@pytest.mark.parametrize(
    ("expected", "found", "tolerance", "status"),
    [
        (100.0, 100.0, 0.0, "pass"),
        (100.0, math.nextafter(100.0, 0.0), 0.0, "fail"),
        (100.0, 100.9, 0.01, "pass"),
        (100.0, 101.1, 0.01, "fail"),
        (-100.0, -100.9, 0.01, "pass"),
        (100.0, math.nan, 0.01, "fail"),
        ("pass", "fail", 0.0, "fail"),
        ("1", 1.0, 0.0, "fail"),
    ],
)
def test_answers_agree_within_the_tolerance(stops, expected, found, tolerance, status):
    assert asked(stops, lambda stops: Answer(expected, found), tolerance=tolerance).status == status


def test_an_advisory_check_only_warns(stops):
    assert asked(stops, lambda stops: Answer("read back", "nothing"), advisory=True).status == "warning"


def test_without_a_compiler_the_controller_in_c_is_skipped(stops, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    assert status_of(stops, "c-controller") == "skipped"


def test_a_controller_from_outside_that_answers_otherwise_is_found(stops, monkeypatch):
    files = known_stops.templates.controller_files("python")
    files["my_wsp.py"] = files["my_wsp.py"].replace('"default": 0.15', '"default": 0.16')
    monkeypatch.setattr(known_stops.templates, "controller_files", lambda language: files)
    assert status_of(stops, "python-controller") == "fail"


def test_a_cache_that_keeps_nothing_is_a_warning(stops, monkeypatch):
    monkeypatch.setattr(user_cache, "read", lambda kind, inputs: None)
    assert status_of(stops, "cache") == "warning"


def installed(folder, content):
    """Return a package of one file as an installer leaves it."""
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    (folder / "uictest").mkdir()
    (folder / "uictest" / "limits.yaml").write_bytes(content)
    record = folder / "uictest-0.dist-info"
    record.mkdir()
    (record / "METADATA").write_text("Metadata-Version: 2.1\nName: uictest\nVersion: 0\n")
    (record / "RECORD").write_text(f"uictest/limits.yaml,sha256={digest},{len(content)}\nuictest/own.pyc,,\n")
    return Distribution.at(record)


@pytest.mark.parametrize(("content", "status"), [(b"1 s", "pass"), (b"2 s", "fail"), (None, "fail")])
def test_an_installed_file_that_was_changed_or_removed_is_found(
    stops, tmp_path, monkeypatch, content, status
):
    own = installed(tmp_path, b"1 s")
    file = tmp_path / "uictest" / "limits.yaml"
    file.unlink()
    if content is not None:
        file.write_bytes(content)
    monkeypatch.setattr(examination, "distribution", lambda name: own)
    assert status_of(stops, "installed-files") == status


PACKAGE = Path(uictest.__file__).parent
DIGESTS = known_stops._stored_reference()["data"]
CRITERIA = "plans/library/criteria/uic-541-05-appendix-b.yaml"


@pytest.fixture
def package(tmp_path):
    """A copy of the shipped data, what a wheel adds, and what Python and editors leave beside them."""
    for name in DIGESTS:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(PACKAGE / name, tmp_path / name)
    left = tmp_path / "plans/library" / "__pycache__" / "__init__.cpython-311.pyc"
    left.parent.mkdir()
    left.write_bytes(b"")
    (tmp_path / "plans/library/scenarios").mkdir()
    (tmp_path / "plans/library/scenarios/slip-120.yaml").write_bytes(b"")  # as in a wheel
    (tmp_path / "plans/library" / ".swap").write_bytes(b"")
    return tmp_path


def finding(monkeypatch, package, stops):
    monkeypatch.setattr(known_stops, "data_digests", lambda: data_digests(package))
    check = next(each for each in selftest.all_checks(stops) if each.id == "shipped-data")
    return selftest.examine(stops, [check]).findings[0]


def test_the_data_of_this_version_pass(monkeypatch, package, stops):
    assert CRITERIA in DIGESTS
    assert finding(monkeypatch, package, stops).status == "pass"


def test_a_changed_limit_in_the_library_of_criteria_is_found_and_named(monkeypatch, package, stops):
    file = package / CRITERIA
    file.write_bytes(file.read_bytes().replace(b"0", b"1", 1))
    found = finding(monkeypatch, package, stops)
    assert (found.status, found.found, found.reason) == ("fail", 1.0, f"{CRITERIA} was changed")


def test_files_that_are_missing_or_new_are_named(monkeypatch, package, stops):
    (package / CRITERIA).unlink()
    (package / "plans/library/criteria/own.yaml").write_text("")
    found = finding(monkeypatch, package, stops)
    assert found.reason == f"plans/library/criteria/own.yaml is not part of it, {CRITERIA} is missing"
