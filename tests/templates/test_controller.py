"""A first controller is sound as it is written: it conforms and stops a train; in C it is the same one."""

import shutil
import subprocess
from pathlib import Path

import pytest

from uictest.plans import templates
from uictest.plans.scenario import load, load_controller
from uictest.plans.scenario.yaml import plain, read_file
from uictest.running import campaign
from uictest.selftest import conformance
from uictest.selftest.conformance.bench import Bench

REPOSITORY = Path(__file__).parents[2]


def write_files(language, folder):
    folder.mkdir()
    for name, text in templates.controller_files(language).items():
        (folder / name).write_text(text, "utf-8")


def written(language, folder):
    """Write the files, build them where they must be built, and return the part."""
    write_files(language, folder)
    if language == "c":
        compiler = shutil.which("gcc") or shutil.which("cc")
        if compiler is None:
            pytest.skip("no C compiler")
        strict = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-fPIC", "-shared"]
        subprocess.run([compiler, "-O2", *strict, "-o", "libwsp.so", "wsp.c"], cwd=folder, check=True)
    return folder / "my-wsp.yaml"


@pytest.fixture(params=["python", "c"])
def part(request, tmp_path):
    """The part of a first controller, ready to run."""
    return written(request.param, tmp_path / request.param)


def test_it_conforms_untouched(part):
    examination = conformance.examine(
        conformance.subject_of("first", load_controller(str(part), trusted=[part.parent]))
    )
    judged = [each for each in examination.findings if each.id != "in-time"]  # the machine's, not its own
    assert {each.status for each in judged} == {"pass"}, judged


def test_its_wheelsets_slide_in_a_slip_brake_test_but_do_not_lock(part):
    """Deeper than `uictest-stop` allows, which its scenario says."""
    [case] = load([part.parent / "slip-120.yaml"])
    result = campaign.run_stop(
        campaign.Stop(case), campaign.RecordingRequest("none", every=1.0)
    ).case_run.result
    assert result.met, result
    assert {each.id for each in result.criteria if each.status == "fail"} == {
        *("wheelset-contact-energy", "distance-over-reference")
    }
    assert {each.id for each in result.criteria} >= {"initial-adhesion", "minimum-slide", "locked-wheels"}


def test_both_languages_give_the_same_answers(tmp_path):
    answers = []
    for language in ("python", "c"):
        file = written(language, tmp_path / language)
        with file.open("a", encoding="utf-8") as text:
            text.write("cycle_time: 40 ms\n")  # which leaves a quarter of the cycles
        part = load_controller(str(file))
        with Bench(conformance.subject_of(language, part)) as bench:
            answers.append([each.drives[0].outputs for each in bench.every_situation()])
    for one, other in zip(*answers, strict=True):
        assert one.tobytes() == other.tobytes()


def test_make_builds_what_the_part_names(tmp_path):
    if shutil.which("make") is None or shutil.which("cc") is None:
        pytest.skip("no make, or no C compiler")
    write_files("c", tmp_path / "made")
    subprocess.run(["make", "-s"], cwd=tmp_path / "made", check=True)
    assert load_controller(str(tmp_path / "made" / "my-wsp.yaml"))


def _controllers(node):
    """Yield the controllers from outside that a shipped file names in place."""
    if isinstance(node, dict):
        if {"python", "library", "connect"} & node.keys():
            yield node
        for inner in node.values():
            yield from _controllers(inner)


SHIPPED = {"examples": REPOSITORY / "examples", "templates": Path(str(templates.__file__)).parent}


@pytest.mark.parametrize("folder", SHIPPED.values(), ids=SHIPPED.keys())
def test_what_is_shipped_declares_its_parameters(folder):
    shipped = [
        (path, each) for path in folder.rglob("*.yaml") for each in _controllers(plain(read_file(path)))
    ]
    assert shipped
    for path, controller in shipped:
        program = path.parent / str(controller.get("python", ""))
        declares = program.is_file() and "\nPARAMETERS = {" in program.read_text("utf-8")
        assert declares or controller.get("declared_parameters"), path
