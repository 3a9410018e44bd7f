"""Records that hold what the contract lets a controller see, and nothing else."""

from types import SimpleNamespace

import pytest

from uictest.controllers import CONTROLLERS
from uictest.core.record import fields_of
from uictest.plans.scenario import load_part

CYCLE = 0.01


def _record(*fields):
    """An object with these fields alone: reading or writing any other is an AttributeError."""
    return type("Record", (), {"__slots__": fields})()


class Bench:
    """A controller with its memory and four speed sensors."""

    def __init__(self, controller, parameters, speed):
        self.controller = controller
        self.parameters = parameters
        self.train = _record(*fields_of(controller.train_memory))
        self.wheelsets = [_record(*fields_of(controller.wheelset_memory)) for _ in range(4)]
        controller.begin(self.train, self.wheelsets, speed)

    def commands(self, *speeds):
        """Commands of one cycle in which the sensors read these speeds, m/s."""
        return self.commands_of(*speeds, valid=(1, 1, 1, 1))

    def commands_of(self, *speeds, valid, dynamic=(0.0, 0.0, 0.0, 0.0)):
        """Commands of one cycle in which some sensors may report a fault and motors brake."""
        if self.controller.contract > 1:
            for wheelset, share in zip(self.wheelsets, dynamic, strict=True):
                wheelset.dynamic_brake = share
        for wheelset, speed, sound in zip(self.wheelsets, speeds, valid, strict=True):
            wheelset.measured_speed, wheelset.speed_valid = speed, sound
        self.controller.decide(self.train, self.wheelsets, self.parameters)
        return [wheelset.valve_command for wheelset in self.wheelsets]

    @property
    def reference(self):
        """The controller's estimate of the train's speed, m/s."""
        return float(self.train.reference_speed)


def _shipped(name):
    return {key: float(value) for key, value in load_part(f"controllers/{name}") if isinstance(value, float)}


def _threshold(speed, **changes):
    """With speeds that jump or stand still, as no wheelset's do: any of them is plausible unless changed."""
    any_speed = {"largest_acceleration": 1e4, "jump_tolerance": 100.0, "stuck_time": 60.0}
    fixed = {"cycle_time": CYCLE, "reference_deceleration": 1.8, **any_speed}
    return Bench(
        CONTROLLERS["threshold"], SimpleNamespace(**{**_shipped("threshold"), **fixed, **changes}), speed
    )


def _slip_band(speed):
    parameters = SimpleNamespace(
        cycle_time=CYCLE, lower_slide=0.08, upper_slide=0.20, reference_deceleration=1.8, minimum_speed=1.4
    )
    return Bench(CONTROLLERS["slip-band"], parameters, speed)


@pytest.fixture(name="threshold_bench", scope="session")
def _threshold_bench():
    """Build a bench with the threshold controller at a speed in m/s and changed parameters."""
    return _threshold


@pytest.fixture(name="slip_band_bench", scope="session")
def _slip_band_bench():
    """Build a bench with the slip-band controller at a speed in m/s."""
    return _slip_band


@pytest.fixture(
    name="bench", params=[_threshold, _slip_band], ids=["threshold", "slip-band"], scope="session"
)
def _bench(request):
    """Build a bench with either controller."""
    return request.param
