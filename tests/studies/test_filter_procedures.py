"""Filters that are fitted in one way and judged on stops that they have not seen."""

from types import SimpleNamespace as Some

import numpy as np

from studies.experiments.cylinder_dynamics import QUANTITIES
from studies.filter_procedures import PROCEDURES, filter_error, fitted_filter, procedure_errors, worst_note
from uictest import Recording

TOP = 4e5


def recorded(seconds=6.0, lag=0.05, step=0.01):
    """Tank 2 in steps, and a cylinder that follows it with a lag of first order: a filter follows exactly."""
    time = np.arange(0.0, seconds, step)
    tank = TOP * (0.5 + 0.4 * np.sign(np.sin(2.0 * time)))
    cylinder = np.empty_like(tank)
    cylinder[0] = tank[0]
    share = 1.0 - np.exp(-step / lag)
    for k in range(1, len(tank)):
        cylinder[k] = cylinder[k - 1] + share * (tank[k] - cylinder[k - 1])
    names = ("measured_pressure_2", "cylinder_pressure_2", "cylinder_pressure_thermal_2")
    channels = {"time": time, "cylinder_pressure_1": cylinder, **dict.fromkeys(names, tank)}
    return Recording(channels, {name: "s" if name == "time" else "Pa" for name in channels})


def test_a_filter_follows_what_is_linear_and_no_other_cylinder():
    recording = recorded()
    fitted = fitted_filter(recording)
    errors = procedure_errors(recording, TOP, {"own_stop": fitted, "free": fitted})
    assert errors.keys() == PROCEDURES.keys()
    assert errors["own_stop"] < 0.5
    assert errors["nothing"] == errors["full"] == errors["thermal"] > 50.0
    slow, quick = recorded(lag=0.2), recorded(lag=0.05)
    assert filter_error(quick, fitted_filter(slow), TOP) > 10.0 * filter_error(
        quick, fitted_filter(quick), TOP
    )


def test_the_worst_is_named_with_its_place():
    def held(friction, error):
        scenario = Some(rail=Some(friction=friction), brake=Some(position="R"))
        return Some(case=Some(scenario=scenario), wheelset=2, errors=dict.fromkeys(PROCEDURES, error))

    note = worst_note([held(0.1, 7.5), held(0.2, 3.0)], "full")
    assert "7.5 % at friction 0.1, position R, wheelset 2" in note


def test_every_procedure_is_judged():
    keys = {each.key for each in QUANTITIES}
    assert keys >= {f"held_out_{value}_{name}" for value in ("median", "worst") for name in PROCEDURES}
