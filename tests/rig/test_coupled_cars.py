"""Several cars, coupled, on one rail."""

from collections import Counter

import numpy as np
import pytest

from uictest.rig import train_assembly
from uictest.rig.model.balance import energy_residual
from uictest.rig.model.train import point_position, point_speed, run_train
from uictest.rig.simulation import run_coupled
from uictest.rig.stepped import SteppedTrain
from uictest.rig.train_assembly import Coupling, assemble_train
from uictest.rig.train_stop import compiled_rig, run_to_end, run_train_to_end

from ..stop_bits import bits
from .plain_numbers import run_on_numbers

COUPLED = Coupling(distance=26.4)
LOOSE = Coupling(distance=26.4, stiffness=0.0, damping=0.0)
DRY = ("rail.condition=dry", "initial_speed=60 km/h")
WET = ("rail.friction=0.07", "initial_speed=60 km/h")
CLEANED = (*WET, "rail.condition=wet-curves")
SHORT = ("initial_speed=14 km/h", "until=13.5 km/h", "simulation.time_step=1 ms")


def coupler_energy(coupler, leading, leading_p, trailing, trailing_p):
    """Energy that a coupler's spring has taken, J.

    A force that is constant within a step works with the mean of the speeds at both ends, while positions
    advance with the speed at the end: k/2 times the product of the stretch now and a step ago.
    """
    stretch = point_position(leading, leading_p, coupler) - point_position(trailing, trailing_p, coupler)
    rate = point_speed(leading, leading_p, coupler) - point_speed(trailing, trailing_p, coupler)
    return 0.5 * float(coupler.stiffness) * stretch * (stretch - float(leading_p.step) * rate)


@pytest.mark.parametrize(
    "overrides",
    [
        WET,
        CLEANED,
        ("brake.dynamic={force: 100 kN, power: 2 MW}", *DRY),
        (*CLEANED, "sanders=[{wheelset: 2, density: 7.5 g/m}]"),
    ],
)
def test_a_train_of_one_car_has_the_bits_of_a_car_alone(rig, overrides):
    train = run_coupled([rig.case(*overrides)], COUPLED, steps_per_sample=20)
    alone = rig.stop(*overrides, every=20)
    assert bits(train.cars[0]) == bits(alone)
    assert train.cars[0].trace.wheelsets.tobytes() == alone.trace.wheelsets.tobytes()


def test_cars_that_nothing_couples_stop_as_each_alone(rig):
    cases = [rig.case(*WET), rig.case(*WET, "brake.command=60 %"), rig.case(*WET)]
    train = run_coupled(cases, LOOSE)
    for j, overrides in enumerate([WET, (*WET, "brake.command=60 %"), WET]):
        inputs = rig.inputs(*overrides)
        inputs.parameters["noise_key"] = train.parameters[j]["noise_key"]
        assert bits(train.cars[j]) == bits(run_to_end(compiled_rig(), inputs))


def test_two_equal_cars_with_equal_noise_stop_as_one_and_do_not_pull(rig, monkeypatch):
    monkeypatch.setattr(train_assembly, "_KEY_STEP", 0)
    train = run_coupled([rig.case(*WET)] * 2, COUPLED)
    assert bits(train.cars[0]) == bits(train.cars[1]) == bits(rig.stop(*WET))
    assert train.couplers["largest_pull"][0] == train.couplers["largest_push"][0] == 0.0


@pytest.mark.parametrize("overrides", [DRY, WET, CLEANED, (*DRY, "rail.gradient=-10 permille")])
def test_energy_of_every_car_and_of_the_couplers_closes(rig, overrides):
    """Work of the couplers on the cars is what their springs gave less what their dampers took."""
    cases = [rig.case(*overrides, f"brake.command={share} %") for share in (100, 40, 80)]
    train = run_coupled(cases, COUPLED)
    # Sliding wheelsets shake the dampers, whose loss is counted with the rate at the beginning of a step.
    closes = 1e-8 if "rail.friction=0.07" in overrides else 1e-9
    for car in train.cars:
        assert abs(car.measures.energy_residual) < closes
        assert abs(car.measures.air_residual) < 1e-9
    cars, p, couplers = [each.car for each in train.cars], train.parameters, train.couplers
    stored = sum(coupler_energy(couplers[j], cars[j], p[j], cars[j + 1], p[j + 1]) for j in (0, 1))
    work = sum(car.coupler_work for car in cars)
    assert couplers["loss"].min() > 0.0
    assert work + stored + couplers["loss"].sum() == pytest.approx(0.0, abs=1e-9 * cars[0].initial_energy)


def test_a_train_decelerates_by_the_mean_of_its_cars_and_a_coupler_carries_the_difference(rig):
    """m a = F - B1 = -F - B2: both slow down by the mean, and the coupler carries half of the difference."""
    cases = [rig.case(*DRY), rig.case(*DRY, "brake.command=50 %")]
    train = run_coupled(cases, COUPLED, steps_per_sample=20)
    alone = [run_coupled([case], COUPLED, steps_per_sample=20).cars[0].trace.train for case in cases]
    at = slice(450, 550)  # 4.5 to 5.5 s: brakes built up, none near its standstill
    slowing = [-np.polyfit(run["time"][at], run["speed"][at], 1)[0] for run in alone]
    coupled = train.cars[0].trace.train
    assert -np.polyfit(coupled["time"][at], coupled["speed"][at], 1)[0] == pytest.approx(
        np.mean(slowing), rel=0.02
    )
    mass = train.parameters["total_mass"][0]
    half_of_difference = 0.5 * mass * (slowing[0] - slowing[1])
    assert train.couplers["largest_push"][0] == pytest.approx(half_of_difference, rel=0.15)


def test_a_command_along_a_pipe_reaches_every_car_later(rig):
    piped = Coupling(distance=25.0, stiffness=0.0, damping=0.0, pipe_speed=250.0)
    slow = (*DRY, "initial_speed=20 km/h")
    train = run_coupled([rig.case(*slow)] * 4, piped, steps_per_sample=1)
    begins = [each.trace.train["time"][each.trace.train["demanded_pressure"] > 0.0][0] for each in train.cars]
    np.testing.assert_allclose(np.diff(begins), 0.1, atol=1e-9)
    for j, car in enumerate(train.cars):
        dead_time, key = (train.parameters[j][name] for name in ("dead_time", "noise_key"))
        alone = run_to_end(compiled_rig(), rig.inputs(*slow, dead_time=dead_time, noise_key=key))
        assert bits(car) == bits(alone)


def test_every_car_runs_on_the_rail_that_those_before_it_have_cleaned(rig):
    train = run_coupled([rig.case(*CLEANED)] * 3, COUPLED, steps_per_sample=20)
    distance = train.parameters["half_pivot_distance"][0] * 2.0 + 2.5
    for leading, trailing in zip(train.cars, train.cars[1:], strict=False):
        left = leading.trace.wheelsets["cleaned_share"][:, 3]
        place = leading.trace.train["distance"] - distance
        met = trailing.trace.wheelsets["cleaned_share"][:, 0]
        here = trailing.trace.train["distance"] - COUPLED.distance
        there = (here > 0.0) & (here < place[-1])
        # It meets what the last wheelset before it left there, of which it may carry over less.
        carried = train.parameters["carry_over"][0] * np.interp(here[there], place, left)
        assert np.all(met[there] >= carried - 0.02)
    friction = [each.trace.wheelsets["friction"][:, 0].mean() for each in train.cars]
    assert friction[0] < friction[1] < friction[2]


def test_plain_code_gives_the_bits_of_compiled_code(rig):
    cases = [rig.case(*CLEANED, *SHORT), rig.case(*CLEANED, *SHORT, "brake.command=80 %")]
    stepped = run_train_to_end(run_on_numbers(run_train), assemble_train(cases, COUPLED))
    for one, other in zip(run_coupled(cases, COUPLED).cars, stepped.cars, strict=True):
        assert bits(one) == bits(other)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ("initial_speed=50 km/h", "car 2: initial_speed"),
        ("simulation.time_step=1 ms", "car 2: step"),
        ("seed=7", "car 2: seed"),
        ("rail.gradient=5 permille", "car 2: its rail"),
    ],
)
def test_what_a_train_has_only_once_is_the_same_in_all_cars(rig, change, told):
    with pytest.raises(ValueError, match=told):
        run_coupled([rig.case(*DRY), rig.case(*DRY, change)], COUPLED)


def test_cars_that_overlap_and_a_train_without_cars_are_refused(rig):
    with pytest.raises(ValueError, match="overlap"):
        run_coupled([rig.case(*DRY)] * 2, Coupling(distance=20.0))
    with pytest.raises(ValueError, match="at least one car"):
        run_coupled([], COUPLED)


SLIDING_TRAIN = ("rail.condition=wet-curves", "rail.friction=0.07", "initial_speed=25 km/h")
PARTS = ("car", "bogies", "wheelsets")
SECONDS = 9
SLIDES = 0.6
"""Slide from which a valve vents."""


def sliding_train(rig):
    """Begin a stop whose controller cycles are its base steps, so that each shows its state."""
    cases = [rig.case(*SLIDING_TRAIN, f"brake.command={share} %") for share in (100, 60)]
    inputs = assemble_train(cases, Coupling(distance=26.4))
    p = inputs.parameters
    steps_per_cycle = int(p["steps_per_cycle"][0])
    p["cycles"] *= steps_per_cycle
    p["steps_per_cycle"], p["cycle_time"] = 1, p["step"]
    return SteppedTrain(inputs), steps_per_cycle


def states_of(train, steps_per_cycle, steps):
    """Step a train and return the records of its parts after every step, each of shape (steps, n)."""
    parts = [train.memory[part] for part in PARTS]
    states = [np.empty((steps, *part.shape), part.dtype) for part in parts]
    for number in range(steps):
        if number % steps_per_cycle == 0:
            for outputs, slide in zip(train.outputs, train.memory["modules"]["slide"], strict=True):
                outputs["hold"] = outputs["vent"] = slide > SLIDES
        train.step()
        for kept, part in zip(states, parts, strict=True):
            kept[number] = part
    return states


def rates_of(car, bogies, wheelsets, p):
    """Yield every damper of a car as its group, its damping and its rates over time."""

    def along(frame, above):
        return frame["speed"] - above * frame["pitch_rate"]

    def up(frame, ahead):
        return frame["vertical_speed"] + ahead * frame["pitch_rate"]

    for bogie, own in zip(bogies.T, (wheelsets[:, :2], wheelsets[:, 2:]), strict=True):
        for link, height in (("secondary_longitudinal", "secondary_height"), ("link", "link_height")):
            at = p[height]
            rate = along(car, at - p["body_height"]) - along(bogie, at - p["bogie_height"])
            yield link, p[f"{link}_damping"], rate
        rate = up(car, bogie["ahead"]) - bogie["vertical_speed"]
        yield "secondary_vertical", p["secondary_vertical_damping"], rate
        for wheelset in own.T:
            rate = wheelset["speed"] - along(bogie, wheelset["wheel_radius"] - p["bogie_height"])
            yield "primary_longitudinal", p["primary_longitudinal_damping"], rate
            yield "primary_vertical", p["primary_vertical_damping"], up(bogie, wheelset["ahead"])


def test_energy_of_a_sliding_train_closes_with_the_mean_rates_of_its_dampers(rig):
    train, steps_per_cycle = sliding_train(rig)
    parameters = train.memory["parameters"].view(np.recarray)
    cars, bogies, wheelsets = states_of(train, steps_per_cycle, int(SECONDS / parameters[0].step))
    for j, p in enumerate(parameters):
        own = cars[:, j], bogies[:, 2 * j : 2 * j + 2], wheelsets[:, 4 * j : 4 * j + 4]
        last, *of_last = (each[-1:].view(np.recarray)[0] for each in own)
        missing = Counter()
        for group, damping, rate in rates_of(*own, p):
            uncounted = 0.5 * p.step * damping * np.sum(rate[:-1] * np.diff(rate))
            missing[group] += float(uncounted / last.initial_energy)
        residual = energy_residual(last, *of_last, p)
        assert abs(residual) > 1e-9
        assert abs(residual + missing.total()) < 2e-11
        assert max(missing, key=lambda group: abs(missing[group])) == "primary_longitudinal"
