"""The rig stepped by other means, side by side: `python benchmarks/peers.py`.

All but solve_ivp run the rig's own base step, its source on other numbers. The rig runs whole stops with
sensors, controller and measures; the others only the step, in the first seconds of a stop, which favours
them.
"""

import time
from collections.abc import Callable, Iterator
from functools import cache
from importlib.util import find_spec
from statistics import median
from typing import Any

import machine
import numpy as np
from numpy.typing import NDArray
from open_records import opened, rolling, step_in, step_on_floats
from reduced_model import integrated_seconds
from stops import Stop, slide_test

from uictest.rig.lanes import run_in_lanes
from uictest.rig.model.rail import FRICTIONS
from uictest.rig.train_stop import compiled_rig, run_to_end

STOPS = 64
"""Stops run by those that run many."""
TURNS = 5
_WHEELSETS = 4

Peer = tuple[str, Callable[[], float]]
"""A name, and a call that does some work and returns the number of wheelset-steps in it."""


class Column(np.ndarray):
    """One number for each run, never changed in place: the step keeps old values under other names."""

    def __iadd__(self, other: Any) -> Any:  # type: ignore[misc]
        """Add into a new array."""
        return self + other

    def __isub__(self, other: Any) -> Any:  # type: ignore[misc]
        """Subtract into a new array."""
        return self - other


def different_stops(stop: Stop) -> tuple[Any, Any, NDArray[np.float64]]:
    """Return parameters, those of wheelsets and friction laws of stops on rails from slippery to good."""
    parameters = np.repeat(stop.parameters.reshape(1), STOPS).view(stop.parameters.dtype)
    parameters["noise_key"] = np.arange(STOPS)
    rails = np.tile(stop.rail[:, :1], (STOPS, 1, 1))
    rails[:, FRICTIONS, 0] = np.linspace(0.10, 0.30, STOPS)
    return parameters, np.tile(stop.wheelset_parameters, (STOPS, 1)), rails


def one_by_one(stop: Stop) -> float:
    """Run a stop on the rig for single stops."""
    return float(run_to_end(compiled_rig(), stop).car.steps * _WHEELSETS)


def in_lanes(stop: Stop) -> float:
    """Run stops on the rig in lanes."""
    measures = run_in_lanes(*different_stops(stop)).measures
    return float(measures["end_time"].sum() / stop.parameters.step * _WHEELSETS)


def plain_python(stop: Stop, steps: int) -> float:
    """Step the rig in the interpreter."""
    on_floats = step_on_floats()
    rig, parameters = rolling(stop), opened(stop.parameters)
    for _ in range(steps):
        on_floats(rig.car, rig.bogies, rig.wheelsets, parameters)
    return steps * _WHEELSETS


@cache
def step_in_columns() -> Callable[..., None]:
    """Return the rig's step on columns."""
    return step_in(
        lambda c, a, b: np.asarray(np.where(c, a, b)).view(Column), np.minimum, np.maximum, np.sqrt
    )


def numpy_columns(stop: Stop, runs: int, steps: int) -> float:
    """Step many runs at once, each number an array."""
    in_columns = step_in_columns()
    one, parameters = rolling(stop), opened(stop.parameters)
    rig = one.filled([np.full(runs, number, float).view(Column) for number in one.numbers()])
    for _ in range(steps):
        in_columns(rig.car, rig.bogies, rig.wheelsets, parameters)
    return runs * steps * _WHEELSETS


def python_control(stop: Stop, steps: int) -> float:
    """Step the rig as the update function of a discrete nonlinear system of python-control."""
    import control

    on_floats = step_on_floats()
    one, parameters = rolling(stop), opened(stop.parameters)
    start = np.array(list(one.numbers()), float)

    def update(_time: float, x: Any, _input: Any, _parameters: Any) -> list[Any]:
        rig = one.filled(x)
        on_floats(rig.car, rig.bogies, rig.wheelsets, parameters)
        return list(rig.numbers())

    system = control.nlsys(update, None, inputs=1, states=start.size, dt=parameters.step)
    times = np.arange(steps) * parameters.step
    control.input_output_response(system, times, np.zeros(steps), start)
    return steps * _WHEELSETS


class JaxColumns:
    """The step traced by JAX over columns and compiled; one controller cycle per call."""

    def __init__(self, stop: Stop, runs: int) -> None:
        import jax
        import jax.numpy as jnp

        jax.config.update("jax_enable_x64", True)
        one, parameters = rolling(stop), opened(stop.parameters)
        traced = step_in(jnp.where, jnp.minimum, jnp.maximum, jnp.sqrt)

        def advance(numbers: Any, _: None) -> tuple[Any, None]:
            rig = one.filled(numbers)
            traced(rig.car, rig.bogies, rig.wheelsets, parameters)
            return [jnp.broadcast_to(number, (runs,)).astype(float) for number in rig.numbers()], None

        self._cycle = jax.jit(
            lambda numbers: jax.lax.scan(advance, numbers, None, parameters.steps_per_cycle)[0]
        )
        self._start = [jnp.full(runs, number, float) for number in one.numbers()]
        self._work = runs * parameters.steps_per_cycle * _WHEELSETS

    def __call__(self, cycles: int) -> float:
        """Run some controller cycles."""
        numbers = self._start
        for _ in range(cycles):
            numbers = self._cycle(numbers)
        numbers[0].block_until_ready()
        return float(cycles * self._work)


def peers(stop: Stop) -> Iterator[Peer]:
    """Yield the peers, the one that all are compared with first."""
    yield "uictest, scalar", lambda: one_by_one(stop)
    yield "uictest, lanes", lambda: in_lanes(stop)
    yield "numpy over 256 runs", lambda: numpy_columns(stop, 256, 50)
    yield "numpy over 4096 runs", lambda: numpy_columns(stop, 4096, 10)
    if find_spec("jax"):
        one, many = JaxColumns(stop, 1), JaxColumns(stop, 1024)
        yield "JAX scan, 1 run", lambda: one(50)
        yield "JAX scan, 1024 runs", lambda: many(2)
    yield "plain Python", lambda: plain_python(stop, 400)
    yield "python-control, discrete nlsys", lambda: python_control(stop, 100)
    yield (
        "scipy solve_ivp, reduced model",
        lambda: integrated_seconds(stop, 4.0) / stop.parameters.step * _WHEELSETS,
    )


def main() -> None:
    """Run all peers in turns and print a table."""
    everyone = list(peers(slide_test()))
    times: dict[str, list[float]] = {name: [] for name, _ in everyone}
    for _, work in everyone:
        work()
    for _ in range(TURNS):
        for name, work in everyone:
            begin = time.process_time()
            wheelset_steps = work()
            times[name].append((time.process_time() - begin) / wheelset_steps)
    reference = times[everyone[0][0]]
    print(machine.description("numpy", "scipy", "control", "jax"))
    print(f"\n{'processor time per wheelset and 0.5 ms':40} {'ns':>12} {'times scalar':>13}")
    for name, own in times.items():
        ratio = median(a / b for a, b in zip(own, reference, strict=True))
        print(f"{name:40} {1e9 * median(own):12.1f} {ratio:13.3g}")


if __name__ == "__main__":
    main()
