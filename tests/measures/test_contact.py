"""What a wheelset does to its tread and what it makes of the rail, against closed forms."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from uictest.core.measures import begin_slides, begin_train, begin_wheelset, close_contacts
from uictest.core.measures.train import observe_train
from uictest.core.measures.wheelset import observe_contact, observe_wheelset

from .conftest import STANDARD

DEFINITION = SimpleNamespace(**STANDARD)
DECELERATION = 0.8
HIGHEST = 9e3
"""N: largest force of both contacts."""
MASS = 45e3


@dataclass
class Stop:
    """A stop at an even deceleration from 20 m/s; columns of one of its wheelsets, which are alike."""

    interval: float = 0.01
    until: float = 20.0

    def __post_init__(self):
        self.time = np.arange(0.0, self.until + self.interval / 2, self.interval)
        self.speed = 20.0 - DECELERATION * self.time
        self.slide, self.force = np.zeros_like(self.time), np.full_like(self.time, HIGHEST)
        self.pressure = np.full_like(self.time, 3.8e5)

    @property
    def distance(self):
        return 20.0 * self.time - DECELERATION * self.time**2 / 2

    def sums(self, power):
        steps = 0.5 * (power[1:] + power[:-1]) * self.interval
        return np.concatenate([[0.0], np.cumsum(steps)])

    def observed(self):
        train = SimpleNamespace(speed_after_sliding=[np.nan] * 11)
        wheelsets = [SimpleNamespace(maximum_slide_above=[0.0] * 21) for _ in range(4)]
        begin_train(train, 0.0, 0.0, 20.0, 7e5, 3.8e5, 0.0)
        for wheelset in wheelsets:
            begin_wheelset(wheelset)
            begin_slides(wheelset)
        work, loss = self.sums(self.force * self.speed), self.sums(self.force * self.slide * self.speed)
        columns = (self.time, self.distance, self.speed, self.speed * (1 - self.slide), self.pressure)
        for row in np.stack([*columns, work, loss], axis=1)[1:].tolist():
            time, distance, speed, wheel_speed, pressure, done, lost = row
            for number, wheelset in enumerate(wheelsets, start=1):
                rest = (0.0, 0.0, float("nan"))
                observe_wheelset(wheelset, train, DEFINITION, number, time, speed, wheel_speed, *rest)
                contact = (pressure, 3.8e5, done, lost, HIGHEST)
                observe_contact(wheelset, train, DEFINITION, time, speed, *contact)
            observe_train(train, DEFINITION, time, distance, speed, 7e5)
        close_contacts(train, wheelsets, MASS)
        return train, wheelsets


def test_a_locked_wheelset_slides_as_far_as_the_train_runs_and_a_train_that_never_ran_has_no_shares():
    stop = Stop()
    stop.slide[:] = 1.0
    _, wheelsets = stop.observed()
    assert [wheelset.slid_distance for wheelset in wheelsets] == pytest.approx([stop.distance[-1]] * 4)
    train, _ = Stop(until=0.0).observed()
    assert np.isnan([train.deceleration_bogie_1, train.deceleration_bogie_2]).all()


def test_energy_of_the_contacts_is_the_integral_of_force_and_slip_while_it_slides():
    stop = Stop()
    stop.slide[:] = np.where((stop.time > 5.0) & (stop.time <= 9.0), 0.3, 0.02)
    stop.force[:] = 6e3 + 100.0 * stop.time
    _, wheelsets = stop.observed()
    slides = stop.slide > 0.05
    power = stop.force * stop.slide * stop.speed
    expected = np.trapezoid(power[slides], stop.time[slides])
    assert wheelsets[0].contact_energy == pytest.approx(expected, rel=5e-3)
    assert wheelsets[0].slid_distance == pytest.approx(np.ptp(stop.distance[slides]), rel=5e-3)


def test_stop_that_rides_the_friction_maximum_uses_all_adhesion():
    """From the first sliding on the WSP holds the pressure where the creep force is the largest."""
    stop = Stop()
    stop.slide[:] = 0.03
    stop.slide[:50] = 0.2
    stop.pressure[50:] = 2.5e5
    train, wheelsets = stop.observed()
    assert train.adhesion_utilisation == pytest.approx(1.0, abs=1e-9)
    assert wheelsets[2].adhesion_utilisation == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("used", [0.3, 0.8])
def test_utilisation_is_the_share_of_the_work(used):
    stop = Stop()
    stop.slide[:] = 0.2
    stop.force[:] = used * HIGHEST
    train, _ = stop.observed()
    assert train.adhesion_utilisation == pytest.approx(used)


def test_brake_force_that_the_wsp_withholds_is_adhesion_that_is_lost():
    """After its first sliding: half of the way it slides at the maximum, half of it the brake is vented."""
    stop = Stop()
    middle = int(np.searchsorted(stop.distance, stop.distance[-1] / 2))
    stop.slide[:middle] = 0.2
    stop.force[middle:] = 0.0
    stop.pressure[middle:] = 0.5e5
    train, _ = stop.observed()
    assert train.adhesion_utilisation == pytest.approx(0.5, abs=2e-3)


def test_brake_that_grips_under_full_pressure_is_not_limited_by_the_rail():
    stop = Stop()
    stop.slide[:200] = 0.2
    stop.force[200:] = 0.4 * HIGHEST
    train, wheelsets = stop.observed()
    assert train.adhesion_utilisation == pytest.approx(1.0, abs=1e-2)
    assert wheelsets[0].available_work == pytest.approx(HIGHEST * stop.distance[200], rel=1e-2)


def test_before_anything_slid_held_pressure_does_not_count_and_bogies_share_the_deceleration():
    stop = Stop()
    stop.pressure[:] = 1e5
    train, wheelsets = stop.observed()
    assert train.available_work == 0.0
    assert np.isnan([train.adhesion_utilisation, *(each.adhesion_utilisation for each in wheelsets)]).all()
    # Four forces F slow the mass by 4 F / m: half through each bogie.
    train, _ = stop.observed()
    assert train.deceleration_bogie_1 == pytest.approx(2 * HIGHEST / MASS, rel=1e-4)
    assert train.deceleration_bogie_2 == train.deceleration_bogie_1


@pytest.mark.parametrize("interval", [0.02, 0.05, 0.1])
def test_figures_do_not_depend_on_when_the_samples_fall(interval):
    def figures(stop):
        stop.slide[:] = 0.3 * np.sin(stop.time / 2.0) ** 2
        stop.force[:] = HIGHEST * (1.0 - 0.4 * stop.slide)
        stop.pressure[:] = 3.8e5 * (1.0 - 0.2 * np.sin(stop.time / 3.0) ** 2)
        train, (wheelset, *_) = stop.observed()
        ours = train.adhesion_utilisation, train.deceleration_bogie_1
        return [*ours, wheelset.slid_distance, wheelset.contact_energy]

    assert figures(Stop(interval)) == pytest.approx(figures(Stop(0.001)), rel=0.1 * interval)
