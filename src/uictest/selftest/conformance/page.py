"""A controller check as a page: its findings, and what was shown and answered where it misses one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from uictest.core.document import Lines, Table
from uictest.core.recording import Recording
from uictest.report import trace_of
from uictest.report.page import Drawing, drawing_of, plot_data, plots_json, render, sampling_text, script_json
from uictest.selftest.conformance.bench import Answers
from uictest.selftest.conformance.situations import WHEELSETS
from uictest.selftest.findings import Examination, finding_document

_UNITS = {"speed": "m/s", "reference_speed": "m/s", "wheel_speed": "m/s", "valve_command": "1"}


@dataclass(frozen=True, slots=True)
class DrawnSituation:
    """A situation with its plots, and the checks that were missed in it."""

    name: str
    checks: Sequence[str]
    drawing: Drawing
    data: str
    note: str


def examination_html(examination: Examination, missed: Mapping[str, Mapping[str, Answers]]) -> str:
    """Return one page of a controller check; `missed` holds the situations of each check that is missed."""
    answers = {name: own for of_check in missed.values() for name, own in of_check.items()}
    situations = [
        _drawn(name, [check for check, own in missed.items() if name in own], each)
        for name, each in answers.items()
    ]
    _, table, remarks = finding_document(examination).sections
    assert isinstance(table, Table)
    assert isinstance(remarks, Lines)
    return render(
        "conformance.html.j2",
        with_plots=bool(situations),
        running_head=examination.title,
        examination=examination,
        table=table,
        remarks=remarks.sentences,
        situations=situations,
        plots=plots_json(),
    )


def _drawn(name: str, checks: Sequence[str], answers: Answers) -> DrawnSituation:
    trace = trace_of(recording_of(answers))
    data = script_json(plot_data(name, trace))
    return DrawnSituation(name, checks, drawing_of(trace), data, sampling_text(trace))


def recording_of(answers: Answers) -> Recording:
    """Return what was shown to a controller and what it answered; magnets of 0 and 1 alone make a state."""
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
