"""Controllers driven through given cycles: each that was created is closed once, and keeps to its outputs."""

import ctypes

import numpy as np
import pytest

from uictest.controllers import INPUTS, OUTPUTS, Config, ControllerError, ControllerProgram
from uictest.controllers.adapters.instance import CallbackInstance
from uictest.rig.external import drives
from uictest.rig.external.in_process import empty_exchange

CONFIG = Config(4, 0.01, 30.0, (0.46,) * 4, {})


class Instance:
    """Counts how often it is closed."""

    version = ""

    def __init__(self):
        self.closed = 0

    contract = 1
    failed = False

    def reset(self):
        """Nothing to reset."""

    def close(self):
        self.closed += 1


def test_a_controller_that_cannot_be_created_again_was_closed_once(monkeypatch):
    """A second destroy of what a library has created would free its memory twice."""
    created = []

    def opened(*arguments):
        if created:
            raise ControllerError("only one licence")
        created.append(Instance())
        return created[0]

    monkeypatch.setattr(drives, "open_controller", opened)
    program = ControllerProgram("library", "libwsp.so")
    request = drives.DriveRequest(program, CONFIG, np.zeros(0, INPUTS), ("create", "create"))
    with pytest.raises(ControllerError, match="only one licence"):
        drives.drive_controller(request, empty_exchange())
    assert created[0].closed == 1


class Writing(CallbackInstance):
    """Writes one byte somewhere behind the beginning of its outputs."""

    def __init__(self, contract, place):
        super().__init__()
        self.contract, self.place = contract, place

    def reset(self):
        """Nothing to reset."""

    def answer(self, inputs, outputs):
        ctypes.memset(outputs + self.place, 1, 1)


class Interrupted(Writing):
    """Something is raised on the way to its step, as by the handler of a signal."""

    def _step(self, handle, inputs, outputs):
        raise RuntimeError("told to")


def test_an_exception_that_leaves_a_callback_fails_the_step_also_in_the_last_cycle():
    """The system is answered anything: most often 0, that all went well."""
    cycles = np.zeros(1, INPUTS)
    with pytest.raises(ControllerError, match=r"^step failed: RuntimeError: told to \(test_drive.py, line "):
        drives.drive(Interrupted(1, 0), cycles, 0.01, empty_exchange())


PLACES = {name: OUTPUTS.fields[name][1] for name in OUTPUTS.names}


@pytest.mark.parametrize(
    ("contract", "place"),
    [
        *((version, OUTPUTS.itemsize + byte) for version in (1, 2) for byte in (0, 7)),
        *((1, PLACES[name]) for name in ("dynamic_reduction", "sand_request", "track_brake_request")),
    ],
)
def test_a_controller_that_writes_beyond_its_outputs_is_told_so(contract, place):
    with pytest.raises(ControllerError, match=r"wrote beyond its outputs \(cycle 0\)"):
        drives.drive(Writing(contract, place), np.zeros(2, INPUTS), 0.01, empty_exchange())


def test_each_cycle_begins_with_blank_outputs():
    driven = drives.drive(Writing(2, PLACES["vent"]), np.zeros(2, INPUTS), 0.01, empty_exchange())
    assert driven.outputs["vent"].tolist() == [[1, 0, 0, 0]] * 2
    assert not driven.outputs["hold"].any() and not driven.outputs["dynamic_reduction"].any()
    assert np.isnan(driven.outputs["reference_speed"]).all()
