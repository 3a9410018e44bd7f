"""The controllers in examples/, built as a user builds them, and every shipped case with one of them."""

import dataclasses
import hashlib
import shutil
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest

import uictest
from uictest import rig
from uictest.controllers import CONTROLLERS, DEFAULT
from uictest.plans.scenario import load
from uictest.plans.scenario.parts.controller import (
    FmuController,
    LibraryController,
    ProgramFile,
    SocketController,
)
from uictest.plans.scenario.yaml import Document

from ..c_compiler import c_compiler
from ..stop_bits import stop_bits

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
HEADERS = Path(uictest.__file__).parent / "controllers"


@pytest.fixture(scope="session")
def compiler():
    """The C compiler: $CC, else gcc."""
    return c_compiler()


@pytest.fixture(scope="session")
def threshold_library(compiler, tmp_path_factory):
    """examples/threshold-c, made by its Makefile."""
    folder = tmp_path_factory.mktemp("threshold-c") / "built"
    shutil.copytree(EXAMPLES / "threshold-c", folder, ignore=shutil.ignore_patterns("*.so"))
    make = shutil.which("make")
    if make is None:
        pytest.skip("no make")
    subprocess.run([make, "-s", f"CC={compiler}", f"HEADER={HEADERS}"], cwd=folder, check=True)
    return folder / "libwsp.so"


@pytest.fixture(scope="session")
def serve(compiler, tmp_path_factory):
    """Compile examples/socket/serve.c with a controller, without a warning, and return the program."""

    def compiled(controller):
        program = tmp_path_factory.mktemp("serve") / "wsp"
        options = ("-O2", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", f"-I{HEADERS}", "-o", program)
        sources = (EXAMPLES / "socket" / "serve.c", controller)
        subprocess.run([compiler, *options, *sources, "-lm"], check=True)
        return program

    return compiled


@contextmanager
def listening(*command):
    """Start a program at a port that the system chooses, yield where it listens, and end it."""
    with subprocess.Popen([*command, "0"], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            yield process.stdout.readline().removeprefix("listening on ").strip()
        finally:
            process.kill()


def _parameters(case):
    """The parameters of the built-in controller of a case, in SI units."""
    declared = CONTROLLERS[DEFAULT].declared_parameters()
    return {name: float(getattr(case.scenario.controller, name)) for name in declared if name != "cycle_time"}


@pytest.fixture(scope="session")
def parameters_of():
    """The parameters of the built-in controller of a case, in SI units."""
    return _parameters


def _external(case, program):
    common = {
        "parameters": _parameters(case),
        "free_parameters": True,
        "cycle_time": f"{float(case.scenario.controller.cycle_time)} s",
    }
    if isinstance(program, str):
        return SocketController(connect=program, **common)
    digest = hashlib.sha256(program.read_bytes()).hexdigest()
    file = ProgramFile(program.name, str(program), Document("", program.parent, "", digest))
    if program.suffix == ".fmu":
        return FmuController(fmu=file, **common)
    return LibraryController(library=file, **common)


@pytest.fixture(scope="session")
def with_controller():
    """Put a library, an FMU or what listens at an address into a case, with the built-in's parameters."""

    def replaced(case, program):
        scenario = case.scenario.model_copy(update={"controller": _external(case, program)})
        return dataclasses.replace(case, scenario=scenario)

    return replaced


@pytest.fixture(scope="session")
def shipped():
    """Every shipped case with the threshold controller, and one with a dynamic brake on a slippery rail."""
    motors = ["brake.dynamic={force: 40 kN, power: 1 MW, wheelsets: [1, 2, 4]}", "rail.friction=0.07"]
    cases = [*load([ROOT / "scenarios"]), *load([ROOT / "scenarios" / "slide-80.yaml"], motors)[-1:]]
    alone = [case for case in cases if case.train is None]
    return [case for case in alone if case.scenario.controller.algorithm == DEFAULT]


def bits(stop):
    """What a stop has measured, to the bit."""
    return stop_bits(stop.measures, stop.wheelset_measures)


@pytest.fixture(scope="session")
def built_in(shipped):
    """The bits of every shipped stop with the built-in controller."""
    return [bits(rig.simulate(case)) for case in shipped]
