"""The programs of examples/socket: started as a user does, they give the stop of the controller they port."""

import sys
from pathlib import Path

import pytest

from uictest import rig
from uictest.controllers import ControllerError
from uictest.plans.scenario import load

from .conftest import EXAMPLES, bits, listening

FOLDER = EXAMPLES / "socket"
BAD = Path(__file__).parents[1] / "rig" / "external" / "bad.c"
"""A controller that fails where its parameters say."""
SCENARIO = FOLDER / "socket.yaml"
LONGEST = 100
"""Lines below which a program shows how little it takes."""
SLIP_BAND = "{extends: slip-band, reference_deceleration: 1 m/s2, lower_slide: 4 %, upper_slide: 12 %}"
"""The built-in controller with the parameters of the scenario."""


@pytest.fixture(params=["C", "Python"])
def command(request):
    """What starts a program at a port."""
    if request.param == "Python":
        return [sys.executable, FOLDER / "wsp.py"]
    serve = request.getfixturevalue("serve")
    return [serve(FOLDER / "wsp.c")]


def case(controller):
    return load([SCENARIO], [controller])[0]


def test_a_program_gives_the_bits_of_the_built_in_controller_stop_after_stop(command):
    expected = rig.simulate(case(f"controller={SLIP_BAND}"))
    with listening(*command) as address:
        stops = [rig.simulate(case(f"controller.connect={address}")) for _ in range(2)]
    assert [bits(stop) for stop in stops] == [bits(expected)] * 2
    assert stops[0].controller_version in ("slip band in C 1.0", "slip band in Python 1.0")


def test_a_program_refuses_another_version_of_the_protocol(command, monkeypatch):
    monkeypatch.setattr("uictest.controllers.adapters.socket.PROTOCOL_VERSION", 2)
    with (
        listening(*command) as address,
        pytest.raises(ControllerError, match=r"^expected protocol version 1$"),
    ):
        rig.simulate(case(f"controller.connect={address}"))


@pytest.mark.parametrize(
    ("fault", "message"),
    [("create", "told to"), ("reset", "told to"), ("step", "step failed: told to (cycle 100)")],
)
def test_a_controller_in_c_that_fails_ends_its_stop_alone(serve, fault, message):
    failing = f"{{fault: {fault}, at: 100}}"
    with listening(serve(BAD)) as address:
        with pytest.raises(ControllerError) as error:
            rig.simulate(
                case(f"controller={{connect: '{address}', parameters: {failing}, free_parameters: true}}")
            )
        assert str(error.value) == message
        assert rig.simulate(case(f"controller={{connect: '{address}'}}")).controller_version == "1.2"


def test_a_program_is_short():
    for name in ("serve.c", "wsp.c", "wsp.py"):
        assert len((FOLDER / name).read_text("utf-8").splitlines()) < LONGEST, name
