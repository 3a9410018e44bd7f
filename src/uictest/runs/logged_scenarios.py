"""Scenarios made of the stops of a log: each simulates its stop, on the rail that was fitted to it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, NamedTuple, get_args

import numpy as np

from uictest import report
from uictest.core import files
from uictest.core.recording import TIME
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import evaluation
from uictest.plans import library, scenario
from uictest.plans.scenario import yaml
from uictest.recorded import field_data, fitting, service_log
from uictest.running import campaign
from uictest.runs.made_scenario import AGREES, MadeScenario, Source, assumptions, heading, readme
from uictest.runs.scenario_files import load_cases

README: Final = "README.md"
_GOOD: Final = 0.5 * AGREES
"""Share within which one friction for the whole stop is enough; chosen."""
_LARGEST_SCALING, _NEIGHBOURS = 0.05, (0.995, 1.005, 0.99, 1.01)
"""Friction is scaled by the difference of the distances, up to this, then by these: chosen, as a fit may
miss it by half a per cent, for which a WSP vents once more or less near standstill."""
_CELL, _APART = 2.0, 20.0
"""m: precision of the edges of a stretch on which something slid, and what lies between two; chosen."""
_MOST_STRETCHES: Final = 12
_LENGTHS: Final = (20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
"""Of stretches with a friction of their own, m: the shortest of which no more are needed; chosen."""
_OVER_BOUND: Final = 2.0
"""Friction over its lower bound where nothing slid, so that nothing slides in the simulation; chosen."""


_PASSES, _SAME = 3, 0.005
"""Simulations at most until the delay of the trigger, s, stays the same; chosen."""
_DIGITS: Final = 4
"""Of a friction coefficient."""
_LONGEST_NAME: Final = 60
"""Letters of the name of a log in that of a scenario; chosen."""
_LETTERS: Final = 6
"""Of its digest, there too: loggers name every night alike; chosen."""


def write_scenarios(
    sources: Iterable[Source],
    most: int,
    parent: Path,
    preparation: field_data.Preparation,
    folder: Path,
    trusted: Sequence[Path],
) -> list[MadeScenario]:
    """Write scenarios of the first stops of which one can be made, and README.md, in place of earlier ones.

    Args:
        sources: stops, the worst first.
        most: how many scenarios to write at most.
        parent: file of the scenario that they extend.
        preparation: by which the stops were found.
        folder: of the scenarios.
        trusted: folders in which references may lead.

    Raises OSError; ForeignFileError and FolderInUseError as :func:`files.replaced_folder`.
    """
    made: list[MadeScenario] = []
    with files.replaced_folder(folder) as new:
        maker = _Maker(parent, new, preparation, (parent.parent, *trusted))
        for source in sources:
            if sum(not each.problem for each in made) == most:
                break
            made.append(maker.made(source))
            if not made[-1].problem:
                files.write(new, f"{source.file.name}.yaml", made[-1].text)
        files.write(new, README, "\n".join(readme(made)) + "\n")
    return made


class _Maker(NamedTuple):
    parent: Path
    folder: Path
    preparation: field_data.Preparation
    trusted: Sequence[Path]

    def made(self, source: Source) -> MadeScenario:
        """Return the scenario of a stop: one friction, or where that does not do several along the track."""
        stop = source.file.stop
        if stop is None:
            return MadeScenario(source, source.file.unusable)
        if stop.standstill is None:
            return MadeScenario(source, "the record does not hold the standstill")
        try:
            balances = fitting.balances_of(stop, source.case.scenario)
            if not len(balances.windows.first):
                return MadeScenario(source, "the stop is too short for a fit")
            best, fit = self._closest(source, stop, balances)
        except (fitting.FitError, ValueError, yaml.ScenarioErrors) as error:
            return MadeScenario(source, " ".join(str(error).split()))
        return replace(best, text="".join(heading(best)) + self._text(best, stop, fit, final=True))

    def _closest(
        self, source: Source, stop: field_data.RecordedStop, balances: fitting.Balances
    ) -> tuple[MadeScenario, fitting.Fit]:
        """Return the first simulation that is close enough, else the closest, and its fit."""
        time, distance = stop.standstill or (math.nan, math.nan)
        blank = MadeScenario(source, recorded=(distance, time))
        tried: list[tuple[float, fitting.Fit, MadeScenario]] = []

        def is_close(fit: fitting.Fit, scale: float) -> bool:
            made = self._simulated(blank, stop, _scaled(fit, scale))
            if scale != 1.0:
                note = f"friction: {100.0 * (scale - 1.0):+.1f} % by distance and time"
                made = replace(made, assumed=(note, *made.assumed))
            tried.append((scale, fit, made))
            return made.off <= _GOOD or all(each.standing != "found" for each in fit.friction)

        for breaks in dict.fromkeys(((), _edges_of_sliding(balances), _breaks(distance))):
            fit = fitting.fit_balances(balances, breaks, with_pads=False)
            if is_close(fit, 1.0):
                break
            by_distance = 1.0 + tried[-1][2].differences[0]
            if abs(by_distance - 1.0) <= _LARGEST_SCALING and is_close(fit, by_distance):
                break
        else:
            scale, fit, _ = min(tried, key=lambda each: each[2].off)
            any(is_close(fit, scale * factor) for factor in _NEIGHBOURS)
        scale, fit, made = min(tried, key=lambda each: each[2].off)
        return made, _scaled(fit, scale)

    def _simulated(self, made: MadeScenario, stop: field_data.RecordedStop, fit: fitting.Fit) -> MadeScenario:
        """Return the stop on the rail of a fit, simulated until command and trigger lie as far apart."""
        source = made.source
        name = f".{source.file.name}.yaml"
        for _ in range(_PASSES):
            files.write(self.folder, name, self._text(made, stop, fit), listed=False)
            try:
                [case] = load_cases([self.folder / name], None, None, self.trusted)
            finally:
                files.remove(self.folder, name)
            run = campaign.run_stop(campaign.Stop(case), campaign.RecordingRequest("all")).case_run
            if run.recording is None or run.result.measures is None:
                raise ValueError(f"its simulation fails: {run.result.reason}")
            since, (own_time, own_distance) = service_log.read_like(
                run.recording, stop.recording, self.preparation
            )
            place = float(np.interp(since, run.recording[TIME], run.recording["distance"]))
            known = abs(since - made.late[1]) < _SAME
            made = replace(
                made,
                simulated=(own_distance, own_time),
                late=(place, since),
                outcome=run.result.outcome,
            )
            if known:
                break
        course = service_log.command_course(stop.recording, source.case.scenario, made.late[1])
        assumed = tuple(assumptions(source.case.scenario, fit, course))
        return replace(made, assumed=assumed)

    def _text(
        self, made: MadeScenario, stop: field_data.RecordedStop, fit: fitting.Fit, *, final: bool = False
    ) -> str:
        source, own = made.source, made.source.case.scenario
        place, late = made.late
        course = service_log.command_course(stop.recording, own, late)
        speed = fitting.initial_speed(stop) / KILOMETRE_PER_HOUR
        changes: dict[str, Any] = {
            "name": f"{_slug(source.event.file.stem)}-{source.log_digest[:_LETTERS]}-{source.file.name}",
            "title": report.printable(f"Recorded stop: {source.event.file} at {source.event.time:.12g} s"),
            "description": _account(fit),
            "initial_speed": f"{speed:.1f} km/h",
        }
        if course.known_by:
            changes["brake.command"] = course.as_written()
        held = service_log.held_speed(stop.recording)
        if held is not None:
            kept, duration = held[0] / KILOMETRE_PER_HOUR, held[1]
            changes["drag"] = {"speed": f"{kept:.1f} km/h", "duration": f"{duration:.1f} s"}
        if final:
            with_bounds = (
                made.off <= AGREES
                and held is None
                and all(each.name in library.names("criteria") for each in own.criteria)
            )
            if with_bounds:
                changes["criteria"] = [*(each.name for each in own.criteria), _bounds(made)]
            outcome = "pass" if with_bounds and made.outcome == "skipped" else made.outcome
            changes["expect"] = outcome if outcome in get_args(evaluation.Expectation) else "pass"
        shifted = replace(_filled(fit, own), breaks=tuple(round(each + place) for each in fit.breaks))
        return fitting.fitted_yaml(
            source.case, source.statements, shifted, self.parent, self.folder, changes=changes
        )


def _account(fit: fitting.Fit) -> str:
    """Return what the fit found, in words."""
    found = [each.value for each in fit.friction if each.standing == "found"]
    if len(fit.friction) == 1 or not found:
        return f"Fitted to the stop: {fit.friction[0]}."
    spread = f"{min(found):.3f} to {max(found):.3f}"
    return f"Fitted to the stop: friction {spread} in {len(found)} of {len(fit.friction)} stretches."


def _slug(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-")[:_LONGEST_NAME].lower() or "log"


def _breaks(distance: float) -> tuple[float, ...]:
    length = next((each for each in _LENGTHS if distance <= each * _MOST_STRETCHES), _LENGTHS[-1])
    return tuple(length * k for k in range(1, int(distance / length) + 1))


def _edges_of_sliding(balances: fitting.Balances) -> tuple[float, ...]:
    """Return the places at which stretches of the track begin and end on which some wheelset slid, m."""
    samples = balances.samples
    places = np.unique((samples.place[samples.sliding] / _CELL).round())
    if not len(places):
        return ()
    gaps = np.flatnonzero(np.diff(places) > _APART / _CELL)
    firsts, lasts = places[np.concatenate(([0], gaps + 1))], places[np.concatenate((gaps, [len(places) - 1]))]
    edges = [_CELL * edge for pair in zip(firsts - 0.5, lasts + 0.5, strict=True) for edge in pair]
    return tuple(float(edge) for edge in edges if edge > 0.0) if len(edges) <= _MOST_STRETCHES else ()


def _scaled(fit: fitting.Fit, scale: float) -> fitting.Fit:
    return replace(fit, friction=tuple(replace(each, value=scale * each.value) for each in fit.friction))


def _filled(fit: fitting.Fit, own: scenario.Scenario) -> fitting.Fit:
    """Return the fit with a friction everywhere.

    Where nothing slid: that of the nearest stretch where something did, unless the train used more; where
    nothing slid at all, that of a dry rail.
    """
    dry = scenario.load_part("rails/dry")
    assert isinstance(dry, scenario.RailCondition)
    found = {k: each.value for k, each in enumerate(fit.friction) if each.standing == "found"}
    levels = []
    for k, each in enumerate(fit.friction):
        level = found.get(k)
        if level is None:
            nearest = min((abs(place - k), place) for place in found)[1] if found else None
            level = (
                max(float(dry.friction), float(own.rail.highest_friction))
                if nearest is None
                else found[nearest]
            )
            if each.standing == "at least":
                level = max(level, _OVER_BOUND * each.value)
        levels.append(replace(each, standing="found", value=round(min(level, 1.0), _DIGITS)))
    return replace(fit, friction=tuple(levels))


def _bounds(made: MadeScenario) -> dict[str, Any]:
    """Return the criteria that hold a simulation to the record."""
    rows = zip(("distance", "time"), ("m", "s"), made.recorded, made.late, strict=True)
    return {
        "name": "as-recorded",
        "title": "No longer than the recorded stop",
        "criteria": [
            {
                "id": f"recorded-{name}",
                "title": f"At most {100.0 * AGREES:g} % above the recorded {value:.1f} {unit},"
                f" and {late:.1f} {unit} from the command to its mark",
                "clause": "none",
                "layer": "requirement",
                "measure": f"braking_{name}",
                "upper": f"{(1.0 + AGREES) * (value + late):.1f} {unit}",
            }
            for name, unit, value, late in rows
        ],
    }
