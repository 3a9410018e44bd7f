"""Logs made of simulated stops with known truth: what a train with these defects would have recorded."""

import random
from pathlib import Path

import numpy as np
import pyarrow as pa
from pyarrow import parquet

import uictest

STEP = 0.01
SCENARIO = Path(__file__).parents[2] / "scenarios" / "slip-120.yaml"
OF_WHEELSETS = {"cylinder_pressure": "Pa", "valve_command": "1", "clamping_force": "N"}
UNITS = {"time": "s", "speed": "m/s", "brake_line_pressure": "Pa"}
CONDITIONS = """
schema: uictest/scenario/1
name: night
title: Test night
initial_speed: 80 km/h
brake: {command: 100 %, position: R}
rail: {condition: wet, friction: 0.1}
criteria: [uictest-stop]
"""
DRY = {"condition": "dry"}


def own(number, **values):
    """Return the settings of a train one of whose wheelsets has values of its own."""
    return {"vehicle": {"extends": "intercity-180", "wheelsets": {str(number): values}}}


def faults(*rows):
    """Return settings with faults: wheelset, part, kind, value."""
    entries = [
        {"at": "0 s", "wheelset": n, "part": part, "kind": kind} | ({"value": value} if value else {})
        for n, part, kind, value in rows
    ]
    return {"faults": [entries]}


def wet(friction, condition="wet"):
    return {"condition": condition, "friction": f"{friction:.3f}"}


def simulated(rail, speed, seed, settings=None):
    """Return a recorded stop."""
    values = {"initial_speed": f"{speed:.2f} km/h", "seed": seed, "rail": rail, "criteria": "uictest-stop"}
    case, *_ = uictest.load(SCENARIO, set={**values, **(settings or {})})
    return uictest.simulate(case)


def night(seed, dry=3, slippery=11, settings=None, speed=80.0):
    """Return dry stops, then slippery ones on rails of different friction, half of which sliding cleans."""
    draw = random.Random(seed)
    rails = [DRY] * dry
    rails += [wet(draw.uniform(0.06, 0.09), ("wet", "wet-cleaning")[k % 2]) for k in range(slippery)]
    return [
        simulated(rail, speed + draw.uniform(-1.5, 1.5), draw.randrange(10**6), settings) for rail in rails
    ]


def write_log(stops, path, begin=0.0, forces=True):
    """Write stops as one recording: 6 s of running, the stop, standing, running up again.

    Wheel speeds are those of the sensors; `begin` is the time of the first sample, s.
    """
    noise = np.random.default_rng(len(stops))
    blocks = [_block(stop, noise, forces) for stop in stops]
    columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    columns = {"time": begin + STEP * np.arange(len(columns["speed"])), **columns}
    fields = [pa.field(name, pa.float64(), metadata={"unit": _unit(name)}) for name in columns]
    parquet.write_table(pa.table(list(columns.values()), schema=pa.schema(fields)), path)
    return path


def _unit(name):
    return UNITS.get(name) or {**OF_WHEELSETS, "wheel_speed": "m/s"}[name.rpartition("_")[0]]


def _block(stop, noise, forces):
    speed, before, after = float(stop["speed"][0]), 600, 1000

    def padded(samples, first, last):
        run_up = np.full(after, last) if np.ndim(last) == 0 else last
        return np.concatenate((np.full(before, first), samples, run_up))

    up = np.concatenate((np.zeros(300), np.linspace(0.0, 1.0, after - 300)))
    columns = {"speed": padded(stop["speed"], speed, speed * up)}
    for n in (1, 2, 3, 4):
        own = np.asarray(stop[f"measured_speed_{n}"])
        rolling = float(np.mean(own[:5]))
        columns[f"wheel_speed_{n}"] = padded(own, rolling, rolling * up)
        columns[f"wheel_speed_{n}"][:before] *= 1.0 + noise.normal(0.0, 2e-4, before)
    kinds = [kind for kind in OF_WHEELSETS if forces or kind != "clamping_force"]
    for name in ("brake_line_pressure", *(f"{kind}_{n}" for kind in kinds for n in (1, 2, 3, 4))):
        own = np.asarray(stop[name])
        release = np.concatenate((np.linspace(own[-1], 0.0, 200), np.zeros(after - 200)))
        columns[name] = padded(own, own[0], 0.0 if "valve" in name else release)
    return columns
