"""A stop of a log and the scenario made of it: how they compare, in words."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from uictest import report
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.recorded import fitting, service_log
from uictest.runs.recorded_files import RecordedFile

AGREES: Final = 0.02
"""Share within which distance and time of a simulation lie over those of the record; chosen."""


@dataclass(frozen=True, slots=True)
class Source:
    """A stop of a log.

    Args:
        file: its recording.
        event: where it lies.
        log_digest: SHA-256 of the file of the log.
        result: of its judgement.
        case: that it was judged as.
        statements: of the command line, by key.
    """

    file: RecordedFile
    event: service_log.LoggedEvent
    log_digest: str
    result: evaluation.CaseResult
    case: scenario.Case
    statements: Mapping[str, str]


_BEYOND: Final = 1.05
"""Share of the highest pressure of a brake above which a record is of another brake; chosen."""


@dataclass(frozen=True, slots=True)
class MadeScenario:
    """What became of a stop; `problem` says why there is no scenario.

    Args:
        source: the stop.
        problem: empty where there is a scenario.
        text: of its file.
        recorded: distance and time of the record since its trigger, m and s.
        simulated: those of the simulation.
        late: distance and time from the command to the trigger in the simulation, m and s.
        outcome: of the simulation.
        assumed: what the record does not say.
    """

    source: Source
    problem: str = ""
    text: str = ""
    recorded: tuple[float, float] = (math.nan, math.nan)
    simulated: tuple[float, float] = (math.nan, math.nan)
    late: tuple[float, float] = (0.0, 0.0)
    outcome: str = ""
    assumed: tuple[str, ...] = ()

    @property
    def differences(self) -> tuple[float, float]:
        """Differences of distance and time, shares of the recorded ones."""
        distance, time = (a / b - 1.0 for a, b in zip(self.simulated, self.recorded, strict=True))
        return distance, time

    @property
    def off(self) -> float:
        """The larger of the two; infinite where there is no standstill."""
        size = max(map(abs, self.differences))
        return size if math.isfinite(size) else math.inf


def assumptions(own: scenario.Scenario, fit: fitting.Fit, course: service_log.CommandCourse) -> Iterator[str]:
    """Yield what a record does not say, and what stands for it."""
    standings = [each.standing for each in fit.friction]
    if "found" not in standings:
        yield "rail: not seen, the brake never reached its limit; friction of a dry rail"
    elif len(set(standings)) > 1:
        yield "rail: not seen in every stretch; there the friction of the nearest one"
    if not course.known_by:
        yield f"brake command: not recorded; {own.brake.command_text} as stated"
    elif course.beyond > _BEYOND:
        yield f"brake command: full, the record has {course.beyond:.2f} times the most that this brake gives"
    yield f"controller: a record does not hold it; {own.controller.name}, as the scenario has it"
    load = f"{own.vehicle.total_mass / 1e3:.1f} t and {own.rail.gradient.text}"
    yield f"load and gradient: as the scenario has them, {load}"


def heading(made: MadeScenario) -> Iterator[str]:
    """Yield the lines above the scenario of a stop."""
    source, event = made.source, made.source.event
    place = f"sample {event.row + 1}, {event.time:.12g} s, {event.distance:.0f} m from its beginning"
    yield report.printable(f"# Made by `uictest log` of {event.file.name}, {place}.") + "\n"
    yield f"# SHA-256 of the log: {source.log_digest}\n"
    yield f"# Why it is here: {_why(source.result)}\n"
    yield from (f"# Assumed: {each}\n" for each in made.assumed)
    yield f"# {_comparison(made)}\n"
    yield from (report.printable(f"# {each}") + "\n" for each in event.remarks)


def _comparison(made: MadeScenario) -> str:
    distance, time = (f"{round(100.0 * each, 1) + 0.0:+.1f} %" for each in made.differences)
    verdict = (
        ""
        if made.outcome == made.source.result.outcome
        else (f"; recorded {made.source.result.outcome}, simulated {made.outcome}")
    )
    if made.off > AGREES:
        verdict += f"; does not lie over the record: more than {100.0 * AGREES:g} %"
    return (
        f"Recorded {made.recorded[0]:.1f} m, {made.recorded[1]:.2f} s; simulated {made.simulated[0]:.1f} m"
        f" ({distance}), {made.simulated[1]:.2f} s ({time}){verdict}"
    )


def _why(result: evaluation.CaseResult) -> str:
    if result.outcome != "pass":
        failing = [each.id for each in result.criteria if each.status == "fail"]
        return f"{result.outcome}: {', '.join(failing)}" if failing else f"{result.outcome}: {result.reason}"
    margin, criterion = evaluation.narrowest_margin(result)
    return "passes" if margin is None else f"passes by {100.0 * margin:.1f} % ({criterion})"


def readme(made: Sequence[MadeScenario]) -> Iterator[str]:
    """Yield the lines of README.md."""
    yield "# Stops of a log as scenarios"
    yield ""
    yield "Made by `uictest log --scenarios`, the worst stop first; `uictest run` with this folder runs them."
    yield "Add `--trust DIR` where what they extend lies outside of the working folder."
    yield "`expect` is what the simulation gave when it was made."
    yield ""
    written = [each for each in made if not each.problem]
    common = (
        [text for text in written[0].assumed if all(text in each.assumed for each in written)]
        if written
        else []
    )
    yield from (f"Assumed of all: {text}." for text in common)
    yield from ("", "| scenario | why | distance and time | assumed |", "|---|---|---|---|")
    for each in written:
        own = "; ".join(text for text in each.assumed if text not in common)
        cells = (_why(each.source.result), _comparison(each), own)
        yield f"| `{each.source.file.name}.yaml` | {' | '.join(cell.replace('|', '/') for cell in cells)} |"
    if len(written) < len(made):
        yield from ("", "No scenario of:", "")
    for each in made:
        if each.problem:
            yield f"- {each.source.file.name}, {_why(each.source.result)}: {each.problem}"
