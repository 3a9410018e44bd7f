"""What every test of the package shares."""

import ctypes
import gc
import os
import sys
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import SimpleNamespace

# Two processes of tests have two processors: threads of numpy's BLAS would only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import settings
from typer.main import get_command

from uictest import rig
from uictest.cli import entry
from uictest.controllers import CONTROLLERS
from uictest.core import files
from uictest.core.physics import FILL, VENT, arithmetic, fma
from uictest.core.record import fields_of
from uictest.core.recording.formats import isolation

_LONGEST = (
    "rig/test_lanes.py",
    "public_sources/test_pages.py",
    "docs/test_site.py",
    "rig/model/test_module_air.py",
    "kernel/test_library.py",
    "recording/formats/test_hostile_files.py",
    "docs/test_examples.py",
    "report/test_accessibility.py",
    "examples/test_fmu.py",
    "studies/test_bands.py",
    "cli/commands/test_sweep.py",
    "conformance/test_checks.py",
    "report/test_stop_browser.py",
    "examples/test_threshold_c.py",
    "studies/experiments/test_independent_integration.py",
    "report/test_page_browser.py",
    "cli/test_closed_streams.py",
    "rig/external/test_workers.py",
    "cli/commands/test_run_firm.py",
    "report/test_verdicts_browser.py",
    "fmu/test_controller.py",
    "test_damaged_files.py",
    "sweeps/running/test_cluster.py",
    "cli/test_entry.py",
    "ci/test_jobs.py",
    "cli/commands/test_controller.py",
    "rig/external/test_trains.py",
    "rig/test_stepped.py",
    "rig/test_compiled.py",
    "service_log/test_campaign.py",
    "service_log/test_found_stops.py",
    "docs/test_pictures.py",
    "fmu/test_building.py",
    "studies/field/test_search.py",
    "cli/commands/test_sweep_results.py",
    "sweeps/running/test_external.py",
    "selftest/test_selftest.py",
    "firmness/test_varied_case.py",
    "templates/test_controller.py",
    "cli/test_controllers_outside.py",
    "cli/commands/test_identify.py",
    "cli/commands/test_series.py",
    "report/test_laid_over_browser.py",
    "rig/bench/test_identified_air.py",
)
"""Files that take longest. They begin first, lest one process works on them while the others are done.

"""

# How long an example takes says nothing about it on a machine that others use as well.
settings.register_profile("same", deadline=None, derandomize=True, max_examples=50)
settings.register_profile("search", deadline=None, max_examples=1000)
# The suite tries the same examples everywhere, so that no run fails by chance; HYPOTHESIS_PROFILE=search
# tries others.
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))


def pytest_configure():
    """Keep byte code, whatever the shell says.

    Without it each process of tests would compile every file of tests at each run, and each of the hundreds
    of processes that they start what it imports of the sources.
    """
    sys.dont_write_bytecode = False
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_collection():
    """Spare the collector of garbage the search: what is collected and imported stays."""
    gc.disable()


def pytest_collection_modifyitems(items):
    """Put the tests of the files that take longest first."""
    tests = Path(__file__).parent
    places = {tests / name: place for place, name in enumerate(_LONGEST)}
    items.sort(key=lambda item: places.get(item.path, len(places)))


def pytest_collection_finish():
    """Spare the collector of garbage what stays to the end: thousands of tests and all that is imported."""
    gc.freeze()
    gc.enable()
    gc.set_threshold(50_000)


C_FMA = ctypes.CDLL(None if os.name == "posix" else "ucrtbase").fma
"""The C library's fused operation: the bits of ours, which plain Python works out in twenty operations."""
C_FMA.argtypes = [ctypes.c_double] * 3
C_FMA.restype = ctypes.c_double
AS_WRITTEN = fma.__code__


@pytest.fixture(autouse=True, scope="session")
def _c_fma():
    """Let plain Python call the C library's operation: it takes a quarter of the time of ours."""
    vars(arithmetic)["_c_fma"] = C_FMA
    fma.__code__ = (lambda a, b, c: _c_fma(a, b, c)).__code__
    yield
    fma.__code__ = AS_WRITTEN


@contextmanager
def fma_as_written():
    """Lend the operation as it stands in the source."""
    before, fma.__code__ = fma.__code__, AS_WRITTEN
    yield
    fma.__code__ = before


READ_APART = isolation.read_apart
"""Reads a recording in a process of its own."""


def read_here(name, path, request, seconds=0.0):
    """Read a recording as that process does, in this one; formats of libraries are read there."""
    if name not in ("csv", "parquet"):
        yield from READ_APART(name, path, request, seconds)
        return
    with files.temporary_folder() as folder:
        pieces = isolation.pieces_of(name, path, request)
        isolation._reject_failure(isolation.leave(folder, name, pieces, lambda: True), name, path, folder)
        contents = isolation._read_contents(folder)
    yield contents


@pytest.fixture(autouse=True, scope="session")
def _reading():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(isolation, "read_apart", read_here)
        yield


@cache
def _command(first):
    return get_command(APPLICATION(first))


APPLICATION = entry.application
"""Makes the command line for a call with this first word."""


@pytest.fixture(autouse=True, scope="session")
def _once():
    """Make each command line once, and wait for no disk: what a test writes need outlive no power cut."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(entry, "application", _command)
        patch.setattr(os, "fsync", lambda descriptor: None)
        yield


class ControllerOutside:
    """The built-in controller of a case on records of its own, that only sees what a sensor shows."""

    def __init__(self, case):
        inputs = rig.assemble(case)
        names = inputs.parameters.dtype.names
        self.parameters = SimpleNamespace(**{name: inputs.parameters[name].tolist() for name in names})
        self.controller = CONTROLLERS[case.scenario.controller.algorithm]
        self.train = SimpleNamespace()
        memory = fields_of(self.controller.wheelset_memory)
        self.wheelsets = [SimpleNamespace(**dict.fromkeys(memory, 0.0)) for _ in range(4)]
        self.controller.begin(self.train, self.wheelsets, self.parameters.initial_speed)

    def magnets(self, wheel_speeds):
        """Return the state of the holding and of the venting magnets for one cycle."""
        for wheelset, speed in zip(self.wheelsets, wheel_speeds, strict=True):
            wheelset.measured_speed, wheelset.speed_valid = speed, 1
        self.controller.decide(self.train, self.wheelsets, self.parameters)
        commands = [wheelset.valve_command for wheelset in self.wheelsets]
        return [int(each != FILL) for each in commands], [int(each == VENT) for each in commands]

    @property
    def reference_speed(self):
        """Its estimate of the train's speed, m/s."""
        return float(self.train.reference_speed)


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Write a file into the working folder; returns its relative path."""
    monkeypatch.chdir(tmp_path)

    def _write(name, content):
        path = Path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return _write


@pytest.fixture(name="controller_outside", scope="session")
def _controller_outside():
    """Put the controller of a case outside the rig."""
    return ControllerOutside
