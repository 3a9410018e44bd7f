"""Logs made of simulated stops with known truth: what a train would have recorded."""

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


def wet(friction, condition="wet"):
    return {"condition": condition, "friction": f"{friction:.3f}"}


def simulated(rail, speed, seed):
    """Return a recorded stop."""
    values = {"initial_speed": f"{speed:.2f} km/h", "seed": seed, "rail": rail, "criteria": "uictest-stop"}
    case, *_ = uictest.load(SCENARIO, set=values)
    return uictest.simulate(case)


def night(seed):
    """Return 3 dry stops, and 11 on slippery rails of different friction, half of which sliding cleans."""
    draw = random.Random(seed)
    rails = [DRY] * 3
    rails += [wet(draw.uniform(0.06, 0.09), ("wet", "wet-cleaning")[k % 2]) for k in range(11)]
    return [simulated(rail, 80.0 + draw.uniform(-1.5, 1.5), draw.randrange(10**6)) for rail in rails]


def write_log(stops, path, begin=0.0):
    """Write stops as one recording: 6 s of running, the stop, standing, running up again.

    Wheel speeds are those of the sensors; `begin` is the time of the first sample, s.
    """
    noise = np.random.default_rng(len(stops))
    blocks = [_block(stop, noise) for stop in stops]
    columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    columns = {"time": begin + STEP * np.arange(len(columns["speed"])), **columns}
    fields = [pa.field(name, pa.float64(), metadata={"unit": unit_of(name)}) for name in columns]
    parquet.write_table(pa.table(list(columns.values()), schema=pa.schema(fields)), path)
    return path


def unit_of(name):
    return UNITS.get(name) or {**OF_WHEELSETS, "wheel_speed": "m/s"}[name.rpartition("_")[0]]


def _block(stop, noise):
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
    for name in ("brake_line_pressure", *(f"{kind}_{n}" for kind in OF_WHEELSETS for n in (1, 2, 3, 4))):
        own = np.asarray(stop[name])
        release = np.concatenate((np.linspace(own[-1], 0.0, 200), np.zeros(after - 200)))
        columns[name] = padded(own, own[0], 0.0 if "valve" in name else release)
    return columns
