"""What every WSP should keep: the checks, a controller examined by them, and the page of that."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from uictest import report
from uictest.controllers import ControllerError
from uictest.core.document import Lines, Table
from uictest.core.recording import Recording
from uictest.report import page
from uictest.selftest.conformance.bench import ROLLS_AGAIN, SLIDE_BEGINS, WHEELSETS, Answers, Bench, Subject
from uictest.selftest.findings import Examination, Finding, Status, finding_document


class Observation(NamedTuple):
    """Result of a check: a number, None if there was nothing to measure, and a remark in words."""

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
    illegal = 0
    for answers in bench.every_situation():
        for outputs in (driven.outputs for driven in answers.drives):
            hold, vent = outputs["hold"], outputs["vent"]
            illegal += np.sum((hold != 0) & (hold != 1) | (vent != 0) & (vent != 1) | (vent > hold))
            if bench.contract > 1:
                shares, track_brake = outputs["dynamic_reduction"], outputs["track_brake_request"]
                illegal += np.sum(~((shares >= 0.0) & (shares <= 1.0)))
                illegal += np.sum(~np.isin(outputs["sand_request"], (0, 1)))
                illegal += np.sum(~np.isin(track_brake, (0, 1)))
    of_version_2 = ", reductions 0 to 1, requests 0 or 1" if bench.contract > 1 else ""
    words = f"hold and vent are 0 or 1, and vent only with hold{of_version_2}, whatever the inputs"
    return Observation(int(illegal), words)


def _same_after_reset(bench: Bench) -> Observation:
    first, after_reset, second = bench.anything().drives
    different = [_cycles_that_differ(first.outputs, other.outputs) for other in (after_reset, second)]
    counts = [len(cycles) for cycles in different]
    words = f"after reset {counts[0]} cycles differ, with a second controller {counts[1]}"
    return Observation(sum(counts), words + _first_of(np.concatenate(different)))


def _same_beside_another(bench: Bench) -> Observation:
    if _is_at_socket(bench):
        return Observation(None, "a program at a socket need not serve two")
    alone, beside = bench.beside_another().drives
    if not len(beside.outputs):
        return Observation(None, "a process can have only one")
    different = _cycles_that_differ(alone.outputs, beside.outputs)
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


def _cycles_that_differ(one: Any, other: Any) -> Any:
    """Return the cycles in which answers differ by a bit; padding between and after fields is ignored."""
    names = [name for name in one.dtype.names if not name.startswith("padding")]
    differs = np.zeros(len(one), bool)
    for name in names:
        first, second = (outputs[name].reshape(len(one), -1) for outputs in (one, other))
        differs |= ((first != second) & ~((first != first) & (second != second))).any(axis=1)
    return np.flatnonzero(differs)


def _keeps_brake(bench: Bench) -> Observation:
    answers = bench.good_rail()
    acting = ((answers.hold != 0) | (answers.vent != 0)).any(axis=1)
    first = f"; first at {answers.situation.time[acting][0]:.2f} s" if acting.any() else ""
    words = f"every wheelset rolls with the noise of the standard sensors{first}"
    return Observation(int(acting.sum()), words)


def _vents_sliding(bench: Bench) -> Observation:
    times = []
    for wheelset in range(WHEELSETS):
        answers = bench.one_slides(wheelset)
        vented = _while_it_slides(answers, answers.vent[:, wheelset] != 0)
        times.append(float(vented[0] - SLIDE_BEGINS) if len(vented) else np.inf)
    return Observation(max(times), f"from the beginning of the slide; wheelsets 1 to 4: {_times_text(times)}")


def _while_it_slides(answers: Answers, active: Any) -> Any:
    """Return the times at which something is active while a wheelset slides, s."""
    time = answers.situation.time
    return time[active & (time >= SLIDE_BEGINS) & (time < ROLLS_AGAIN)]


def _spares_rolling(bench: Bench) -> Observation:
    vented = [
        np.delete(bench.one_slides(wheelset).vent != 0, wheelset, axis=1).any(axis=1).sum()
        for wheelset in range(WHEELSETS)
    ]
    return Observation(int(sum(vented)), "beside a sliding wheelset")


def _gives_back(bench: Bench) -> Observation:
    answers = [bench.one_slides(wheelset) for wheelset in range(WHEELSETS)]
    times = [
        _time_to_end(answer, n, (answer.hold != 0) | (answer.vent != 0)) for n, answer in enumerate(answers)
    ]
    return Observation(max(times), f"until it is filled for good; wheelsets 1 to 4: {_times_text(times)}")


def _time_to_end(answers: Answers, wheelset: int, acting: Any) -> float:
    """Return the time from rolling again until the last cycle in which the controller acts on it, s."""
    time, train = answers.situation.time, answers.situation.train_speed
    acts = acting[:, wheelset]
    if acts[-1]:
        return np.inf
    last = float(time[acts][-1]) if acts.any() else 0.0
    speed = answers.situation.inputs["wheel_speed"][:, wheelset]
    rolls_again = float(time[(time > ROLLS_AGAIN) & (speed > 0.99 * train)][0])
    return max(last - rolls_again, 0.0)


def _not_vented_for_ever(bench: Bench) -> Observation:
    all_of_them = tuple(range(WHEELSETS))
    answers = [bench.locked(wheelset) for wheelset in all_of_them] + [bench.locked(*all_of_them)]
    times = [_longest_activity(answer.vent != 0) * bench.subject.config.cycle_time for answer in answers]
    words = f"wheelsets 1 to 4 alone: {_times_text(times[:-1])}, all together: {_times_text(times[-1:])}"
    return Observation(max(times), words)


def _survives_lost_sensor(bench: Bench) -> Observation:
    cycle_time = bench.subject.config.cycle_time
    times = [
        _longest_activity(bench.sensor_lost(wheelset).vent != 0) * cycle_time for wheelset in range(WHEELSETS)
    ]
    words = f"any vent while the sensor of wheelset 1 to 4 reports a fault and all roll: {_times_text(times)}"
    return Observation(max(times), words)


def _longest_activity(active: Any) -> int:
    """Return the most cycles in a row in which a wheelset is active; shape of active (cycles, wheelsets)."""
    longest, run = 0, np.zeros(active.shape[1], int)
    for row in active:
        run = (run + 1) * row
        longest = max(longest, int(run.max()))
    return longest


def _reference_speed(bench: Bench) -> Observation:
    answers = [bench.good_rail(), *map(bench.one_slides, range(WHEELSETS))]
    estimates = np.concatenate([answer.reference_speed for answer in answers])
    if np.isnan(estimates).all():
        return Observation(None, "the controller gives no reference speed")
    errors = np.abs(estimates - np.concatenate([answer.situation.train_speed for answer in answers]))
    return Observation(float(np.nanmax(errors)), "while at least three wheelsets roll")


def _answers_in_time(bench: Bench) -> Observation:
    drives = [driven for answers in bench.every_situation() for driven in answers.drives]
    seconds = np.concatenate([driven.seconds for driven in drives])
    usual = float(np.quantile(seconds, 0.99))
    shown = [f"{t * 1e6:.0f} us" if t < 1e-3 else f"{t * 1e3:.1f} ms" for t in (usual, seconds.max())]
    words = f"on this machine; 99 % of {len(seconds)} answers within {shown[0]}, the longest {shown[1]}"
    return Observation(100.0 * usual / bench.subject.config.cycle_time, words)


def _motor_first(bench: Bench) -> Observation:
    times = []
    for wheelset in range(WHEELSETS):
        answers = bench.motor_slides(wheelset)
        reduced = _while_it_slides(answers, answers.reduction[:, wheelset] > 0.0)
        vented = _while_it_slides(answers, answers.vent[:, wheelset] != 0)
        first = len(reduced) and (not len(vented) or reduced[0] < vented[0])
        times.append(float(reduced[0] - SLIDE_BEGINS) if first else np.inf)
    words = (
        f"until it is reduced, never where the valve vents by then; wheelsets 1 to 4: {_times_text(times)}"
    )
    return Observation(max(times), words)


def _spares_motors(bench: Bench) -> Observation:
    """Motors of one bogie may have one converter."""
    others = [slice(2, 4) if wheelset < 2 else slice(0, 2) for wheelset in range(WHEELSETS)]
    reduced = [
        (bench.motor_slides(n).reduction[:, other_bogie] > 0.0).any(axis=1).sum()
        for n, other_bogie in enumerate(others)
    ]
    return Observation(int(sum(reduced)), "in the bogie beside that of a sliding wheelset")


def _motor_back(bench: Bench) -> Observation:
    answers = map(bench.motor_slides, range(WHEELSETS))
    times = [_time_to_end(answer, n, answer.reduction > 0.0) for n, answer in enumerate(answers)]
    return Observation(
        max(times), f"until nothing is taken off for good; wheelsets 1 to 4: {_times_text(times)}"
    )


def _times_text(times: list[float]) -> str:
    return ", ".join("never" if np.isinf(time) else f"{time:.2f} s" for time in times)


CHECKS: Final = (
    Check("legal-commands", "Only commands that a valve has.", 0, "1", _legal_commands),
    Check("same-after-reset", "The same answers after reset.", 0, "cycles", _same_after_reset),
    Check("same-beside-another", "The same answers beside another.", 0, "cycles", _same_beside_another),
    Check("leaves-no-trace", "The state of its process is as before.", 0, "1", _leaves_no_trace),
    Check("keeps-brake", "Brake force is kept on a good rail.", 0, "cycles", _keeps_brake),
    Check("vents-sliding", "A sliding wheelset is vented.", 1.0, "s", _vents_sliding),
    Check("spares-rolling", "The others are not vented.", 0, "cycles", _spares_rolling),
    Check("gives-back", "A rolling wheelset gets its brake back.", 3.0, "s", _gives_back),
    Check("ends-vents", "No wheelset is vented for ever.", 10.0, "s", _not_vented_for_ever),
    Check("lost-sensor", "A lost speed causes no long vent.", 10.0, "s", _survives_lost_sensor),
    Check("reference-speed", "The reference speed is the train's.", 3.0, "m/s", _reference_speed),
    Check("in-time", "Answers come within the cycle.", 100.0, "%", _answers_in_time, advisory=True),
    Check("motor-first", "A sliding wheelset loses its motor first.", 1.0, "s", _motor_first, contract=2),
    Check("spares-motors", "Other motors are not reduced.", 0, "cycles", _spares_motors, contract=2),
    Check("motor-back", "A motor gets its brake back.", 3.0, "s", _motor_back, contract=2),
)
"""In the order of the report; what only a later version of the contract has comes last."""


class Examined(NamedTuple):
    """Findings of the checks of a controller, and the situations of each missed check, by its id."""

    examination: Examination
    missed: Mapping[str, Mapping[str, Answers]]


def examine(subject: Subject) -> Examination:
    """Check a controller; a crash, a hang or an exception of it is a finding with the status `error`."""
    return examined(subject).examination


def examined(subject: Subject) -> Examined:
    """Check a controller and keep what it has answered where it misses a check."""
    findings, missed = [], {}
    with Bench(subject) as bench:
        for check in CHECKS:
            if check.contract > bench.contract:
                continue
            bench.asked = {}
            finding = _finding(check, bench, subject.name)
            findings.append(finding)
            if finding.status in ("fail", "error") and bench.asked:
                missed[check.id] = bench.asked
        about = {f"controller.{name}": text for name, text in subject.description.items()}
        about["controller.version"] = bench.version
        version = f", version {bench.version}" if bench.version else ""
    described = subject.description
    digest = f", SHA-256 {described['sha256'][:12]}" if "sha256" in described else ""
    title = f"controller {described['name']} ({described['kind']}{version}{digest})"
    return Examined(Examination("controller check", title, about, tuple(findings)), missed)


def _finding(check: Check, bench: Bench, controller: str) -> Finding:
    try:
        value, words = check.observe(bench)
        missed: Status = "warning" if check.advisory else "fail"
        status: Status = "skipped" if value is None else "pass" if value <= check.limit else missed
    except ControllerError as error:
        value, words, status = None, str(error), "error"
    return Finding(
        *(check.id, controller, check.requirement, status),
        expected=check.limit,
        found=value,
        tolerance=None,
        unit=check.unit,
        reason=words,
    )


_UNITS = {"speed": "m/s", "reference_speed": "m/s", "wheel_speed": "m/s", "valve_command": "1"}


@dataclass(frozen=True, slots=True)
class DrawnSituation:
    """A situation with its plots, and the checks that were missed in it."""

    name: str
    checks: Sequence[str]
    drawing: page.Drawing
    data: str
    note: str


def examination_html(examination: Examination, missed: Mapping[str, Mapping[str, Answers]]) -> str:
    """Return one page of a controller check; `missed` holds the situations of each check that is missed."""
    answers = {name: own for of_check in missed.values() for name, own in of_check.items()}
    situations = []
    for name, answer in answers.items():
        checks = [check for check, own in missed.items() if name in own]
        trace = report.trace_of(recording_of(answer))
        data = page.script_json(page.plot_data(name, trace))
        situations.append(
            DrawnSituation(name, checks, page.drawing_of(trace), data, page.sampling_text(trace))
        )
    _, table, remarks = finding_document(examination).sections
    assert isinstance(table, Table)
    assert isinstance(remarks, Lines)
    return page.render(
        "conformance.html.j2",
        with_plots=bool(situations),
        running_head=examination.title,
        examination=examination,
        table=table,
        remarks=remarks.sentences,
        situations=situations,
        plots=page.plots_json(),
    )


def recording_of(answers: Answers) -> Recording:
    """Return the inputs and answers of a controller; only magnets of 0 or 1 have a valve state."""
    situation = answers.situation
    channels = {
        "time": situation.time,
        "speed": situation.train_speed,
        "reference_speed": np.asarray(answers.reference_speed, dtype=np.float64),
    }
    for n in range(WHEELSETS):
        hold, vent = answers.hold[:, n], answers.vent[:, n]
        legal = np.isin(hold, (0, 1)) & np.isin(vent, (0, 1)) & (vent <= hold)
        channels[f"wheel_speed_{n + 1}"] = np.asarray(situation.inputs["wheel_speed"][:, n], dtype=np.float64)
        channels[f"valve_command_{n + 1}"] = np.where(legal, hold + vent, np.nan).astype(np.float64)
    units = {name: _UNITS.get(name.rstrip("_1234"), "s") for name in channels}
    return Recording(channels, units)
