"""What the dampers of a sliding train take, counted with the rate that their force really works with.

The rig counts the loss of a damper with its rate at the beginning of a step. Its force works with the mean of
the rates at both ends, and where wheelsets slide the difference is what the balance of energy leaves open.
"""

from collections import Counter

import numpy as np

from uictest.rig.model.balance import energy_residual
from uictest.rig.stepped import SteppedTrain
from uictest.rig.train_assembly import Coupling, assemble_train

WET = ("rail.condition=wet-curves", "rail.friction=0.07", "initial_speed=25 km/h")
PARTS = ("car", "bogies", "wheelsets")
SECONDS = 9
SLIDES = 0.6
"""Slide from which a valve vents."""


def sliding_train(rig):
    """Begin a stop whose controller cycles are its base steps, so that each shows its state."""
    cases = [rig.case(*WET, f"brake.command={share} %") for share in (100, 60)]
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
