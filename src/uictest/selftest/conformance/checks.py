"""What every WSP should keep: the checks."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from uictest.selftest.conformance.bench import Answers, Bench
from uictest.selftest.conformance.situations import ROLLS_AGAIN, SLIDE_BEGINS, WHEELSETS


class Observation(NamedTuple):
    """What was found: a number, None if there was nothing to find, and in words."""

    value: float | None
    words: str


@dataclass(frozen=True, slots=True)
class Check:
    """One fact that controllers should keep.

    Attributes:
        id: its name.
        requirement: one sentence.
        limit: largest value that passes.
        unit: of that value.
        observe: reads the value. Raises ControllerError.
        advisory: whether a larger value is only a warning.
        contract: version of the contract from which on it is checked.
    """

    id: str
    requirement: str
    limit: float
    unit: str
    observe: Callable[[Bench], Observation]
    advisory: bool = False
    contract: int = 1


def _legal_commands(bench: Bench) -> Observation:
    drives = [driven.outputs for each in bench.every_situation() for driven in each.drives]
    illegal = sum(int(_illegal(outputs).sum()) for outputs in drives)
    words = "hold and vent are 0 or 1, and vent only with hold"
    if bench.contract > 1:
        illegal += sum(int(_illegal_in_version_2(outputs).sum()) for outputs in drives)
        words += ", reductions 0 to 1, requests 0 or 1"
    return Observation(illegal, f"{words}, whatever the inputs")


def _illegal(outputs: Any) -> Any:
    hold, vent = outputs["hold"], outputs["vent"]
    return (hold != 0) & (hold != 1) | (vent != 0) & (vent != 1) | (vent > hold)


def _illegal_in_version_2(outputs: Any) -> Any:
    shares, sand = outputs["dynamic_reduction"], outputs["sand_request"]
    track_brake = outputs["track_brake_request"][:, np.newaxis]
    asks_otherwise = ~np.isin(np.concatenate((sand, track_brake), axis=1), (0, 1))
    return np.concatenate((~((shares >= 0.0) & (shares <= 1.0)), asks_otherwise), axis=1)


def _same_after_reset(bench: Bench) -> Observation:
    first, after_reset, second = bench.anything().drives
    different = [_different(first.outputs, other.outputs) for other in (after_reset, second)]
    counts = [len(each) for each in different]
    words = f"after reset {counts[0]} cycles differ, with a second controller {counts[1]}"
    return Observation(sum(counts), words + _first_of(np.concatenate(different)))


def _same_beside_another(bench: Bench) -> Observation:
    if _is_at_socket(bench):
        return Observation(None, "a program at a socket need not serve two")
    alone, beside = bench.beside_another().drives
    if not len(beside.outputs):
        return Observation(None, "a process can have only one")
    different = _different(alone.outputs, beside.outputs)
    return Observation(len(different), f"answered in turn with a second controller{_first_of(different)}")


def _first_of(cycles: Any) -> str:
    return f"; first in cycle {cycles.min()}" if len(cycles) else ""


def _is_at_socket(bench: Bench) -> bool:
    program = bench.subject.program
    return program is not None and program.kind == "connect"


def _leaves_no_trace(bench: Bench) -> Observation:
    if _is_at_socket(bench):
        return Observation(None, "a program at a socket has a process of its own")
    bench.anything()
    left = ", ".join(bench.traces) or "modes of floating point, locale, folder, signals are as they were"
    return Observation(len(bench.traces), left)


def _different(one: Any, other: Any) -> Any:
    """Return the cycles in which answers differ by a bit; C may leave anything between and behind fields."""
    names = [name for name in one.dtype.names if not name.startswith("padding")]
    differs = np.zeros(len(one), bool)
    for name in names:
        first, second = (each[name].reshape(len(one), -1) for each in (one, other))
        differs |= ((first != second) & ~((first != first) & (second != second))).any(axis=1)
    return np.flatnonzero(differs)


def _keeps_brake(bench: Bench) -> Observation:
    answers = bench.good_rail()
    acting = ((answers.hold != 0) | (answers.vent != 0)).any(axis=1)
    first = f"; first at {answers.situation.time[acting][0]:.2f} s" if acting.any() else ""
    return Observation(
        int(acting.sum()), f"every wheelset rolls with the noise of the standard sensors{first}"
    )


def _vents_sliding(bench: Bench) -> Observation:
    times = [_time_to_vent(bench.one_slides(each), each) for each in range(WHEELSETS)]
    return Observation(max(times), f"from the beginning of the slide; wheelsets 1 to 4: {_listed(times)}")


def _time_to_vent(answers: Answers, wheelset: int) -> float:
    time = answers.situation.time
    vented = time[(answers.vent[:, wheelset] != 0) & (time >= SLIDE_BEGINS) & (time < ROLLS_AGAIN)]
    return float(vented[0] - SLIDE_BEGINS) if len(vented) else np.inf


def _spares_rolling(bench: Bench) -> Observation:
    vented = [
        np.delete(bench.one_slides(each).vent != 0, each, axis=1).any(axis=1).sum()
        for each in range(WHEELSETS)
    ]
    return Observation(int(sum(vented)), "beside a sliding wheelset")


def _gives_back(bench: Bench) -> Observation:
    answers = map(bench.one_slides, range(WHEELSETS))
    times = [_time_to_end(each, n, (each.hold != 0) | (each.vent != 0)) for n, each in enumerate(answers)]
    return Observation(max(times), f"until it is filled for good; wheelsets 1 to 4: {_listed(times)}")


def _time_to_end(answers: Answers, wheelset: int, acting: Any) -> float:
    """Return the time from rolling again until the last cycle in which the controller acts on it, s."""
    acts = acting[:, wheelset]
    if acts[-1]:
        return np.inf
    last = answers.situation.time[acts][-1] if acts.any() else 0.0
    return max(float(last) - _rolls_at(answers, wheelset), 0.0)


def _not_vented_for_ever(bench: Bench) -> Observation:
    all_of_them = tuple(range(WHEELSETS))
    answers = [bench.locked(each) for each in all_of_them] + [bench.locked(*all_of_them)]
    times = [_longest(each.vent != 0) * bench.subject.config.cycle_time for each in answers]
    words = f"wheelsets 1 to 4 alone: {_listed(times[:-1])}, all together: {_listed(times[-1:])}"
    return Observation(max(times), words)


def _survives_lost_sensor(bench: Bench) -> Observation:
    cycle_time = bench.subject.config.cycle_time
    times = [_longest(bench.sensor_lost(each).vent != 0) * cycle_time for each in range(WHEELSETS)]
    words = f"any vent while the sensor of wheelset 1 to 4 reports a fault and all roll: {_listed(times)}"
    return Observation(max(times), words)


def _longest(active: Any) -> int:
    """Return the most cycles in a row in which a wheelset is active; shape of active (cycles, wheelsets)."""
    longest, run = 0, np.zeros(active.shape[1], int)
    for row in active:
        run = (run + 1) * row
        longest = max(longest, int(run.max()))
    return longest


def _reference_speed(bench: Bench) -> Observation:
    answers = [bench.good_rail(), *map(bench.one_slides, range(WHEELSETS))]
    estimates = np.concatenate([each.reference_speed for each in answers])
    if np.isnan(estimates).all():
        return Observation(None, "the controller gives no reference speed")
    errors = np.abs(estimates - np.concatenate([each.situation.train_speed for each in answers]))
    return Observation(float(np.nanmax(errors)), "while at least three wheelsets roll")


def _answers_in_time(bench: Bench) -> Observation:
    seconds = np.concatenate([driven.seconds for each in bench.every_situation() for driven in each.drives])
    usual, longest = np.quantile(seconds, 0.99), seconds.max()
    within = f"99 % of {len(seconds)} answers within {_short(usual)}, the longest {_short(longest)}"
    return Observation(100.0 * float(usual) / bench.subject.config.cycle_time, f"on this machine; {within}")


def _short(seconds: float) -> str:
    return f"{seconds * 1e6:.0f} us" if seconds < 1e-3 else f"{seconds * 1e3:.1f} ms"


def _motor_first(bench: Bench) -> Observation:
    times = [_time_to_reduce(bench.motor_slides(each), each) for each in range(WHEELSETS)]
    words = f"until it is reduced, never where the valve vents by then; wheelsets 1 to 4: {_listed(times)}"
    return Observation(max(times), words)


def _time_to_reduce(answers: Answers, wheelset: int) -> float:
    time = answers.situation.time
    slides = (time >= SLIDE_BEGINS) & (time < ROLLS_AGAIN)
    reduced = time[(answers.reduction[:, wheelset] > 0.0) & slides]
    vented = time[(answers.vent[:, wheelset] != 0) & slides]
    if len(reduced) == 0 or (len(vented) and vented[0] <= reduced[0]):
        return np.inf
    return float(reduced[0] - SLIDE_BEGINS)


def _spares_motors(bench: Bench) -> Observation:
    """Motors of one bogie may have one converter."""
    others = [slice(2, 4) if each < 2 else slice(0, 2) for each in range(WHEELSETS)]
    reduced = [
        (bench.motor_slides(n).reduction[:, each] > 0.0).any(axis=1).sum() for n, each in enumerate(others)
    ]
    return Observation(int(sum(reduced)), "in the bogie beside that of a sliding wheelset")


def _motor_back(bench: Bench) -> Observation:
    answers = map(bench.motor_slides, range(WHEELSETS))
    times = [_time_to_end(each, n, each.reduction > 0.0) for n, each in enumerate(answers)]
    return Observation(max(times), f"until nothing is taken off for good; wheelsets 1 to 4: {_listed(times)}")


def _rolls_at(answers: Answers, wheelset: int) -> float:
    """Return when a wheelset that has slid rolls again, s."""
    time, train = answers.situation.time, answers.situation.train_speed
    speed = answers.situation.inputs["wheel_speed"][:, wheelset]
    return float(time[(time > ROLLS_AGAIN) & (speed > 0.99 * train)][0])


def _listed(times: list[float]) -> str:
    return ", ".join("never" if np.isinf(time) else f"{time:.2f} s" for time in times)


CHECKS: Final = (
    Check("legal-commands", "Only commands that a valve has.", 0, "1", _legal_commands),
    Check("same-after-reset", "The same answers after reset.", 0, "cycles", _same_after_reset),
    Check("same-beside-another", "The same answers beside another.", 0, "cycles", _same_beside_another),
    Check("leaves-no-trace", "The state of its process is as before.", 0, "1", _leaves_no_trace),
    Check("keeps-brake", "Brake force is kept on a good rail.", 0, "cycles", _keeps_brake),
    Check("vents-sliding", "A sliding wheelset is vented.", 1.0, "s", _vents_sliding),
    Check("spares-rolling", "The others are not vented.", 0, "cycles", _spares_rolling),
    Check("gives-back", "A wheelset that rolls again gets its brake back.", 3.0, "s", _gives_back),
    Check("ends-vents", "No wheelset is vented for ever.", 10.0, "s", _not_vented_for_ever),
    Check("lost-sensor", "No wheelset is vented for long without a speed.", 10.0, "s", _survives_lost_sensor),
    Check("reference-speed", "The reference speed is that of the train.", 3.0, "m/s", _reference_speed),
    Check(
        "in-time", "Answers come within the cycle.", 100.0, "% of the cycle", _answers_in_time, advisory=True
    ),
    Check("motor-first", "A sliding wheelset loses its motor first.", 1.0, "s", _motor_first, contract=2),
    Check("spares-motors", "Other motors are not reduced.", 0, "cycles", _spares_motors, contract=2),
    Check("motor-back", "A motor gets its brake back.", 3.0, "s", _motor_back, contract=2),
)
"""In the order of the report; what only a later version of the contract has comes last."""
