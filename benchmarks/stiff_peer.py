"""The rig's search for the slip speed against a stiff integrator: `python benchmarks/stiff_peer.py`.

One wheelset under its share of the car. Speeds V of the car and v of the wheelset, stretch x of the primary
suspension between them, rotation omega, and the work W that sliding takes at the rail:

    M V' = k x + c x'      m v' = -(k x + c x') - F      J omega' = r F - T      x' = v - V      W' = F w

with w = v - r omega and Polach's creep force F(w, v), written here from the paper. While the wheelset turns,
the brake torque T is prescribed. Where omega comes to zero, the wheelset is locked until r F exceeds T. Radau
(relative tolerance 1e-9) begins anew at every kink of the torque, every lock and every release.

The rig's own search and step, in plain Python with one, two and six Newton steps, meet the same torque. The
error of six is that of the implicit Euler step; what one and two add to it is theirs. `--step 1` takes steps
of 1 ms; `-k WORD` selects situations.
"""

import argparse
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import machine
import numpy as np
from newton_steps import SEARCHES
from numpy.typing import NDArray
from open_records import opened
from scipy.integrate import solve_ivp
from stops import SCENARIOS

from uictest.plans.scenario import load
from uictest.rig import assemble
from uictest.rig.model.running_gear import step_wheelset

Array = NDArray[np.float64]
Program = tuple[tuple[float, float], ...]
"""Times in s and torques over 2 Q mu0 r, that of full friction; linear between, a step at a repeated time."""
_SLIDES: Program = (
    (0, 0),
    (0.4, 1.4),
    (0.7, 1.4),
    (0.75, 0.1),
    (1.2, 0.1),
    (1.4, 1.2),
    (1.7, 1.2),
    (1.75, 0.4),
)
_RELEASE: Program = ((0, 0), (0.3, 0.6), (0.6, 0.6), (0.6, 0))
_STEPS: Program = (
    (0, 0),
    (0.1, 0),
    (0.1, 1.5),
    (0.2, 1.5),
    (0.2, 0),
    (0.4, 0),
    (0.4, 0.5),
    (0.8, 0.5),
    (0.8, 0),
)
_LOCK: Program = ((0, 0), (0.3, 3.0), (1.4, 3.0), (1.5, 0))
_STIFF = "rail.condition={extends: wet, reduction_adhesion: 1, reduction_slip: 1}"
_SOFT = "rail.condition={extends: wet, reduction_adhesion: 0.1, reduction_slip: 0.02}"
_FALLING = "rail.condition={extends: wet, friction_ratio: 0.2, friction_decay: 1 s/m}"
SITUATIONS: dict[str, tuple[float, float, Program, list[str]]] = {
    "slides, 80 km/h": (22.2, 0.1, _SLIDES, []),
    "slides, stiff contact": (22.2, 0.1, _SLIDES, [_STIFF]),
    "slides, soft contact": (22.2, 0.1, _SLIDES, [_SOFT]),
    "slides, falling friction": (22.2, 0.1, _SLIDES, [_FALLING]),
    "slides, falling, mu 0.03": (22.2, 0.03, _SLIDES, [_FALLING]),
    "slides, falling, mu 0.3": (22.2, 0.3, _SLIDES, [_FALLING]),
    "release": (22.2, 0.1, _RELEASE, []),
    "release, stiff contact": (22.2, 0.1, _RELEASE, [_STIFF]),
    "release, 5 km/h": (1.4, 0.1, _RELEASE, []),
    "steps of torque": (22.2, 0.1, _STEPS, []),
    "steps, stiff contact": (22.2, 0.1, _STEPS, [_STIFF]),
    "locked, 36 km/h": (10.0, 0.1, _LOCK, []),
    "locked, falling friction": (10.0, 0.1, _LOCK, [_FALLING]),
    "locked, falling, mu 0.03": (3.0, 0.03, _LOCK, [_FALLING]),
    "walking pace, 5 km/h": (1.4, 0.05, _SLIDES, []),
    "walking pace, stiff": (1.4, 0.05, _SLIDES, [_STIFF]),
    "walking pace, locked": (1.4, 0.03, _LOCK, []),
}
"""Name -> speed in m/s, mu0, torque and what is set in the scenario."""
_REST = 0.5
"""Time for which the last torque is held, s."""
_TURN = 1e-6
"""Slip speed, and change of it in a step, whose sign counts, m/s."""
_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Course:
    """Slip speed in m/s and rotation in rad/s at the ends of steps, and the work of sliding in J."""

    slip: Array
    rotation: Array
    work: float

    @property
    def sign_changes(self) -> int:
        """How often the slip changes its sign."""
        return _changes_of_sign(self.slip)

    @property
    def turns(self) -> int:
        """How often the slip turns from rising to falling or back."""
        return _changes_of_sign(np.diff(self.slip))

    @property
    def standing(self) -> int:
        """Steps at whose end the wheelset stands."""
        return int((self.rotation == 0.0).sum())

    @property
    def departures(self) -> int:
        """How often a wheelset that stood turns."""
        stands = self.rotation == 0.0
        return int((stands[:-1] & ~stands[1:]).sum())


def _changes_of_sign(values: Array) -> int:
    signs = np.sign(values[np.abs(values) > _TURN])
    return int((signs[1:] != signs[:-1]).sum())


class Wheelset:
    """Parameters of one wheelset on its rail, from a shipped scenario."""

    def __init__(self, speed: float, friction: float, settings: list[str], step: float) -> None:
        settings = [*settings, f"rail.friction={friction}", f"simulation.time_step={1e3 * step:g} ms"]
        [case] = load([SCENARIOS / "low-adhesion-80.yaml"], settings)
        inputs = assemble(case)
        self.p, self.own = opened(inputs.parameters), opened(inputs.wheelset_parameters[0])
        self.speed, self.friction, self.step = speed, friction, step
        self.car_mass = self.p.total_mass / 4.0 - self.p.wheelset_mass
        self.full_torque = 2.0 * self.p.static_wheel_load * friction * self.own.wheel_radius

    def creep_force(self, slip: float, speed: float) -> float:
        """Force of the rail on both wheels against the motion in N: Polach (2005), his equations."""
        p, size = self.p, abs(slip)
        fading = (1.0 - p.friction_ratio) * math.exp(-p.friction_decay * size) + p.friction_ratio
        limit = p.static_wheel_load * self.friction * fading
        load_ratio = p.static_wheel_load / p.reference_load
        gradient = p.creep_stiffness * load_ratio ** (2.0 / 3.0) * size / (max(abs(speed), 0.01) * limit)
        adhesion = p.reduction_adhesion * gradient / (1.0 + (p.reduction_adhesion * gradient) ** 2)
        force = 2.0 * limit / math.pi * (adhesion + math.atan(p.reduction_slip * gradient))
        return math.copysign(2.0 * force, slip)


def integrated(wheelset: Wheelset, program: Program, times: Array) -> Course:
    """Return the course that the stiff integrator finds, at these times."""
    state = np.array([wheelset.speed, wheelset.speed, 0.0, wheelset.speed / wheelset.own.wheel_radius, 0.0])
    ends, locked, found = [*program, (float(times[-1]), program[-1][1])], False, [state]
    for (begin, first), (end, last) in pairwise(ends):
        time = begin
        while time < end:
            torque = _line(begin, end, wheelset.full_torque * first, wheelset.full_torque * last)
            solution = _until_event(*_motion(wheelset, torque, locked), (time, end), state)
            time, before, state = float(solution.t[-1]), time, solution.y[:, -1]
            found += [solution.sol(at) for at in times[(times > before + 1e-9) & (times <= time + 1e-9)]]
            if solution.status == 1:
                locked, state[3] = not locked, 0.0
    states = np.array(found)
    rotation = np.where(np.abs(states[:, 3]) < _TURN, 0.0, states[:, 3])
    return Course(states[:, 1] - wheelset.own.wheel_radius * rotation, rotation, float(states[-1, 4]))


def _until_event(rates: Any, event: Any, span: tuple[float, float], state: Array) -> Any:
    tolerances = _TOLERANCE * np.array([1.0, 1.0, 1e-3, 1.0, 1e3])
    options = {"events": event, "dense_output": True, "max_step": 1e-3}
    return solve_ivp(rates, span, state, method="Radau", rtol=_TOLERANCE, atol=tolerances, **options)


def _line(begin: float, end: float, first: float, last: float) -> Callable[[float], float]:
    return lambda time: first + (last - first) * (time - begin) / (end - begin)


def _motion(wheelset: Wheelset, torque: Callable[[float], float], locked: bool) -> tuple[Any, Any]:
    """Return the rates of the state, and what comes to zero when the wheelset locks or is let go."""
    p, radius = wheelset.p, wheelset.own.wheel_radius

    def rates(time: float, state: Array) -> list[float]:
        car_speed, speed, stretch, rotation, _ = state
        rate, slip = speed - car_speed, speed - radius * rotation
        creep = wheelset.creep_force(slip, speed)
        pull = p.primary_longitudinal_stiffness * stretch + p.primary_longitudinal_damping * rate
        spin = 0.0 if locked else (radius * creep - torque(time)) / p.wheelset_inertia
        return [pull / wheelset.car_mass, -(pull + creep) / p.wheelset_mass, rate, spin, creep * slip]

    def locks(_: float, state: Array) -> float:
        return float(state[3])

    def is_let_go(time: float, state: Array) -> float:
        return float(radius * wheelset.creep_force(state[1], state[1]) - torque(time))

    event: Any = is_let_go if locked else locks
    event.terminal, event.direction = True, 1.0 if locked else -1.0
    return rates, event


def stepped(wheelset: Wheelset, program: Program, count: int, steps: int) -> Course:
    """Return the course of the rig's own search and step, with this number of Newton steps."""
    p, radius = wheelset.p, wheelset.own.wheel_radius
    record, bogie = _record(wheelset), SimpleNamespace(moment=0.0, pitch_rate=0.0)
    car_speed, stretch, slips, rotations = wheelset.speed, 0.0, [0.0], [record.rotation]
    for i in range(count):
        record.torque = wheelset.full_torque * _torque_at((i + 0.5) * wheelset.step, program)
        rate = record.speed - car_speed
        pull = p.primary_longitudinal_stiffness * stretch + p.primary_longitudinal_damping * rate
        found, forces = SEARCHES[steps]([record] * 4, (-pull,) * 4, p)
        step_wheelset(record, bogie, -pull, forces[0], found[0], p)  # type: ignore[arg-type]
        car_speed += wheelset.step * pull / wheelset.car_mass
        stretch += wheelset.step * (record.speed - car_speed)
        slips.append(record.speed - radius * record.rotation)
        rotations.append(record.rotation)
    return Course(np.array(slips), np.array(rotations), record.contact_loss)


def _record(wheelset: Wheelset) -> Any:
    """Return what the rig's step reads and writes of a wheelset."""
    rolling = {
        "speed": wheelset.speed,
        "rotation": wheelset.speed / wheelset.own.wheel_radius,
        "friction": wheelset.friction,
        "wheel_load": wheelset.p.static_wheel_load,
    }
    nought = dict.fromkeys(("position", "angle", "contact_loss", "creep_force", "torque"), 0.0)
    return SimpleNamespace(**vars(wheelset.own), **rolling, **nought)


def _torque_at(time: float, program: Program) -> float:
    for (begin, first), (end, last) in pairwise(program):
        if time < end:
            return _line(begin, end, first, last)(time)
    return program[-1][1]


def rows(word: str, step: float) -> Iterator[str]:
    """Yield a row for each situation: errors in mm/s and %, counts of the peer and of each search."""
    for name, (speed, friction, program, settings) in SITUATIONS.items():
        if word in name:
            wheelset = Wheelset(speed, friction, settings, step)
            count = round((program[-1][0] + _REST) / step)
            peer = integrated(wheelset, program, step * np.arange(1.0, count + 1.0))
            courses = [stepped(wheelset, program, count, steps) for steps in (1, 2, 6)]
            yield f"{name:26}{_errors(peer, courses)}{_counts(peer, courses)}"


def _errors(peer: Course, courses: list[Course]) -> str:
    off = [1e3 * (course.slip - peer.slip) for course in courses]
    largest = "".join(f"{np.abs(each).max():8.2f}" for each in off)
    usual = "".join(f"{math.sqrt((each**2).mean()):8.3f}" for each in off)
    search = "".join(f"{1e3 * np.abs(each.slip - courses[2].slip).max():9.1e}" for each in courses[:2])
    work = "".join(f"{100.0 * (each.work / peer.work - 1.0):+7.3f}" for each in courses)
    return f"{largest} |{usual} |{search} |{work}"


def _counts(peer: Course, courses: list[Course]) -> str:
    counts = ("sign_changes", "turns", "standing", "departures")
    return "".join(" |" + "".join(f"{getattr(each, name):5}" for each in (peer, *courses)) for name in counts)


def main() -> None:
    """Print a table for the given step."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--step", type=float, default=0.5, help="ms")
    parser.add_argument("-k", dest="word", default="")
    given = parser.parse_args()
    print(machine.description("numpy", "scipy"))
    print(
        f"Slip speed, steps of {given.step:g} ms; three columns: 1, 2, 6 Newton steps; four: the peer first"
    )
    print(
        f"{'':26}{'largest error, mm/s':>24} |{'rms error, mm/s':>24} |{'1, 2 off 6, mm/s':>18} |"
        f"{'work of sliding, %':>21} |{'changes of sign':>20} |{'turns':>20} |{'steps at stand':>20} |"
        f"{'departures':>20}"
    )
    for row in rows(given.word, 1e-3 * given.step):
        print(row, flush=True)


if __name__ == "__main__":
    main()
