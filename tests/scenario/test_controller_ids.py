"""Ids name a controller by the name of its part; two programs of one name are told apart."""

from hashlib import sha256

import pytest

from uictest.plans.scenario import load
from uictest.plans.series import load_series
from uictest.plans.sweeps import load_sweep

BOTH = "matrix: {controller: [v23/wsp.yaml, v24/wsp.yaml]}\n"


def _part(write, folder, program, name="name: wsp\n", more=""):
    """Write a controller; return the digits of its program."""
    program += "class Wsp: ...\n"
    write(f"{folder}/wsp.py", program.encode())
    write(f"{folder}/wsp.yaml", f"schema: uictest/controller/1\n{name}python: wsp.py\nclass: Wsp\n{more}")
    return sha256(program.encode()).hexdigest()[:8]


def _version(text):
    return f"__version__ = {text!r}\n"


def test_a_controller_is_named_by_its_part_not_by_its_file(write, loaded, head):
    _part(write, "v23", "", "name: ours\n")
    _part(write, "v24", "")
    cases = loaded(f"{head}matrix: {{controller: [v23/wsp.yaml, v24/wsp.yaml, threshold]}}\n")
    assert [case.id for case in cases] == [
        f"stop[controller={name}]" for name in ("ours", "wsp", "threshold")
    ]


@pytest.mark.parametrize(
    ("versions", "suffixes"),
    [
        (("2.3", "2.4"), ("2.3", "2.4")),
        (("2.4 beta/1", "2.4"), ("2.4beta1", "2.4")),
        (("2.3", "2.3"), None),
        (("2.3", ""), None),
        (("2.4/", "2.4"), None),  # the same in the characters of a file name
    ],
)
def test_programs_of_one_name_have_their_versions_or_digests(write, loaded, head, versions, suffixes):
    digests = [
        _part(write, folder, f"{_version(version)}# {folder}\n")
        for folder, version in zip(("v23", "v24"), versions, strict=True)
    ]
    ids = [case.id for case in loaded(head + BOTH)]
    assert ids == [f"stop[controller=wsp@{suffix}]" for suffix in suffixes or digests]


def test_a_comma_list_series_and_sweeps_name_them_alike(write, head):
    """`controller=v23/wsp.yaml,v24/wsp.yaml` was refused as the same id."""
    _part(write, "v23", _version("2.3"))
    _part(write, "v24", _version("2.4"))
    expected = ["controller=wsp@2.3", "controller=wsp@2.4"]
    stop = write("stop.yaml", head)
    cases = load([stop], ["controller=v23/wsp.yaml,v24/wsp.yaml"])
    assert [case.id for case in cases] == [f"stop[{each}]" for each in expected]
    include = "include: [{controller: v23/wsp.yaml}, {controller: v24/wsp.yaml}]\n"
    stops = "dry: {scenario: stop.yaml, set: {rail.condition: dry}}\nwet: {scenario: stop.yaml}\n"
    series = write("a.series.yaml", f"schema: uictest/series/1\nname: a\n{stops}{include}")
    assert [each.id for each in load_series(series)] == [f"a[{each}]" for each in expected]
    vary = "vary: {matrix: {controller: [v23/wsp.yaml, v24/wsp.yaml]}}\n"
    plan = load_sweep(
        write("a.sweep.yaml", f"schema: uictest/scenario/1\nname: a\nextends: stop.yaml\n{vary}")
    )
    assert [row[0].label for row in plan.groups[0].rows] == ["wsp@2.3", "wsp@2.4"]


def test_one_program_with_other_parameters_needs_a_name(write, refused, head):
    for folder, more in (("v23", "parameters: {a: 1}\n"), ("v24", "parameters: {a: 2}\n")):
        _part(write, folder, "", more=f"{more}free_parameters: true\n")
    (error,) = refused(head + BOTH)
    assert "make the same case id" in error.message
    assert "give each a `name`" in error.hint
