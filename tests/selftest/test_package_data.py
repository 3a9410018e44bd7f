"""Shipped data that were changed are found, in a working tree as in an installed package."""

import shutil
from pathlib import Path

import pytest

import uictest
from uictest import selftest
from uictest.selftest import known_stops
from uictest.selftest.known_stops import data_digests

PACKAGE = Path(uictest.__file__).parent
STORED = known_stops._stored_reference()["data"]
CRITERIA = "plans/library/criteria/uic-541-05-appendix-b.yaml"


@pytest.fixture
def package(tmp_path):
    """A copy of the shipped data, what a wheel adds, and what Python and editors leave beside them."""
    for name in STORED:
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
    assert CRITERIA in STORED
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
