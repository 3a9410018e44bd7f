"""Two versions of a controller in one run: each has the modules that lie beside its own file."""

import re
from contextlib import nullcontext

import pytest

from uictest.controllers import ControllerError
from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.external.in_process import run_in_process
from uictest.rig.external.workers import Workers

WSP = """
from uictest.controllers import Outputs
import shared_logic

class Wsp:
    def __init__(self, config): pass
    def reset(self): pass
    def step(self, inputs): return Outputs([0] * 4, [0] * 4, shared_logic.SPEED)
"""


@pytest.fixture
def version_of(folder):
    """A stop with the controller of a folder; its helper module has the folder's number."""

    def inputs(name):
        (folder / name).mkdir(exist_ok=True)
        (folder / name / "wsp.py").write_text(WSP, "utf-8")
        (folder / name / "shared_logic.py").write_text(f"SPEED = {name[1:]}.0\n", "utf-8")
        scenario = folder / "stop.yaml"
        text = scenario.read_text("utf-8").partition("controller:")[0]
        scenario.write_text(f"{text}controller: {{python: {name}/wsp.py, class: Wsp}}\n", "utf-8")
        return assemble(load([scenario])[0])

    return inputs


def test_each_version_imports_what_lies_beside_it_and_no_child_what_lies_in_the_working_folder(
    version_of, folder
):
    stops = {name: version_of(name) for name in ("v1", "v2", "v1", "v2")}
    with Workers() as workers:
        for name, stop in stops.items():
            speeds = workers.run(stop, 1000).trace.train["reference_speed"]
            assert set(speeds[1:-1]) == {float(name[1:])}, name
    (folder / "mmap.py").write_text('raise RuntimeError("not ours")\n', "utf-8")
    with Workers() as workers:
        workers.run(version_of("v1"))


def test_in_one_process_a_second_version_is_refused(version_of):
    first, second = version_of("v3"), version_of("v4")
    run_in_process(first)
    with pytest.raises(ControllerError, match=r"^wsp\.py may import shared_logic\.py, and this process"):
        run_in_process(second)


def test_a_forked_copy_of_a_controller_does_not_answer(version_of, folder):
    stop = version_of("v1")
    with Workers() as workers:
        expected = workers.run(stop).measures.tobytes()
        forking = WSP.replace("return", "import os; inputs.cycle == 100 and os.fork(); return")
        version_of("v5")
        (folder / "v5" / "wsp.py").write_text(forking, "utf-8")
        stop = assemble(load([folder / "stop.yaml"])[0])
        for _ in range(3):
            assert workers.run(stop).measures.tobytes() == expected


def test_in_one_process_a_library_that_was_built_anew_is_refused(library, stop_of):
    """The system's loader returns the library that it has loaded from the same path."""
    path = library()
    run_in_process(stop_of(library=path.name))
    path.unlink()
    library("-g")
    with pytest.raises(
        ControllerError, match=r"^libbad\.so was built anew: this process has loaded it before"
    ):
        run_in_process(stop_of(library=path.name))


SILENT = "-DSILENT"


@pytest.mark.parametrize(
    ("option", "controller", "message"),
    [
        ("", "parameters: {at: 9999}", ""),
        ("", "parameters: {fualt: none}, free_parameters: true", ""),
        (SILENT, "parameters: {any: 1}, free_parameters: true", ""),
        (SILENT, "declared_parameters: {at: {default: 9999, unit: '1'}}", ""),
        ("", "parameters: {fualt: none}", "parameters.fualt: no parameter fualt; did you mean fault?"),
        ("", "parameters: {at: 10000}", "parameters.at: 10000 is out of range; accepted: 0 to 9999"),
        ("", "parameters: {fault: 1}", "parameters.fault: expected a text, found a number (1)"),
        ("", "declared_parameters: {ta: {default: 1, unit: s}}", "no parameter ta; accepted: fault, at"),
        (SILENT, "parameters: {at: 1}", "declares no parameters, given: at; write `declared_parameters:"),
        ('-DSTATED="[]"', "parameters: {at: 1}", "its parameters are not of the form"),
        ('-DSTATED="{"', "parameters: {at: 1}", "its parameters are not of the form"),
        ('-DSTATED="{\\"at\\": {\\"range\\": [0]}}"', "parameters: {at: 1}", "are not of the form"),
    ],
)
def test_what_a_library_does_not_state_ends_the_stop_unless_the_part_accepts_it(
    folder, library, workers, option, controller, message
):
    library(*filter(None, [option]))
    path = folder / "stop.yaml"
    head = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 40 km/h\n"
    path.write_text(f"{head}controller: {{library: libbad.so, {controller}}}\n", "utf-8")
    stop = assemble(load([path])[0])
    with pytest.raises(ControllerError, match=re.escape(message)) if message else nullcontext():
        workers.run(stop)
