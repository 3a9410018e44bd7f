"""Controllers driven through given cycles: each that was created is closed once."""

import numpy as np
import pytest

from uictest.controllers import INPUTS, Config, ControllerError, ControllerProgram
from uictest.rig.external import drives
from uictest.rig.external.in_process import empty_exchange

CONFIG = Config(4, 0.01, 30.0, (0.46,) * 4, {})


class Instance:
    """Counts how often it is closed."""

    version = ""

    def __init__(self):
        self.closed = 0

    contract = 1

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
