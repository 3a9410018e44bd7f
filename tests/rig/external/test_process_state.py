"""What foreign code changes of its process is put back, and told by the check of controllers."""

import ctypes
import platform

import numpy as np
import pytest

from uictest.controllers import Config
from uictest.rig.external import drives
from uictest.rig.external.in_process import BlockInputs, empty_exchange, run_block, run_in_process
from uictest.rig.external.process_state import ProcessState
from uictest.selftest.conformance.bench import good_rail

from ...stop_bits import stop_bits

CALLS = ("create", "reset", "step", "destroy")
TOLD = {
    "rounding": "rounding mode upward",
    "subnormal": "subnormal numbers flushed to zero",
    "locale": "locale C",
    "folder": "working folder /",
    "signal": "handler of SIGTERM",
    "alarm": "alarm set",
    "numpy": "numpy.seterr",
}
IN_C = [
    "rounding",
    *(["subnormal"] if platform.machine() == "x86_64" else []),
    *("locale", "folder", "signal"),
]
IN_PYTHON = ["rounding", "locale", "folder", "signal", "alarm", "numpy"]
KINDS = [*((what, "c") for what in IN_C), *((what, "python") for what in IN_PYTHON)]


@pytest.fixture
def stop_with(stop_of, library):
    """Return the stop with a fault of the controller in C or in Python."""
    library()

    def stop(fault, kind, at=3):
        if kind == "python":
            return stop_of(f"'{fault}'", at)
        return stop_of(f"'{fault}'", at, library="libbad.so")

    return stop


def bits(finished):
    return stop_bits(finished.measures, finished.wheelset_measures)


def traces(stop):
    """What the calls of a controller leave behind in a few cycles, as the check finds it."""
    config = Config(4, 0.01, 30.0, (0.46,) * 4, stop.config.parameters)
    request = drives.DriveRequest(stop.program, config, good_rail(0.01).inputs[:5])
    return drives.drive_controller(request, empty_exchange()).traces


@pytest.mark.parametrize(("what", "kind"), KINDS)
def test_every_call_leaves_the_process_as_it_was_and_the_check_names_it(stop_with, what, kind):
    before = ProcessState()
    sound = bits(run_in_process(stop_with("none", kind)))
    for call in CALLS:
        stop = stop_with(f"{what}:{call}", kind)
        assert bits(run_in_process(stop)) == sound
        assert before.restore() == {}
        told = "loading or create" if call == "create" else call
        assert traces(stop) == (f"{TOLD[what]} after {told}",)
        assert before.restore() == {}
    assert traces(stop_with("none", kind)) == ()


@pytest.mark.parametrize("what", IN_C)
def test_loading_a_library_changes_nothing_either(stop_of, library, what):
    """As a library built with -ffast-math flushes subnormal numbers once it is loaded."""
    library(f'-DON_LOAD="{what}"', name=f"lib{what}.so")
    assert traces(stop_of(library=f"lib{what}.so")) == (f"{TOLD[what]} after loading or create",)


def test_stops_in_lanes_have_the_bits_of_a_controller_that_leaves_the_modes_alone(stop_with):
    faults = ["none", "rounding:step", "rounding:create", "none", "rounding:destroy", "none"]
    run = run_block(BlockInputs.of([stop_with(fault, "c") for fault in faults]))
    assert run.failures == [""] * len(faults)
    assert len({stop_bits(*each) for each in zip(run.measures, run.wheelset_measures, strict=True)}) == 1


def test_what_is_put_back_are_the_modes_that_were_there_and_not_the_default_ones():
    """The process of a caller may have modes of its own."""
    modes = ctypes.CDLL(None)
    downward = 0x800000 if platform.machine() == "aarch64" else 0x400
    outer = ProcessState()
    try:
        assert modes.fesetround(downward) == 0
        inner = ProcessState()
        modes.fesetround(0)
        with np.errstate(all="ignore"):
            assert inner.restore().keys() == {"rounding mode", "numpy.seterr"}
        assert modes.fegetround() == downward
    finally:
        outer.restore()
    assert modes.fegetround() == 0
