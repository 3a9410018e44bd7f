"""Simulate one stop and record it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from uictest import rig
from uictest.api.arguments import PathName, Trusted, as_paths, checked_seed, sample_interval
from uictest.api.assignments import Assignments, override_texts
from uictest.api.loading import one_case
from uictest.core import recording
from uictest.plans import scenario


def simulate(
    what: PathName | scenario.Case,
    *,
    case: str | None = None,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    seed: int | None = None,
    trust: Trusted = (),
    record: float = 100.0,
) -> recording.Recording:
    """Simulate one stop and return its channels over time; nothing is judged.

    Args:
        what: scenario file, or a case from :func:`uictest.load`.
        case: id of the case, where the file has several.
        set: dotted key -> value, as for :func:`uictest.load`; for files.
        seed: of the sensor noise, 0 to 2^32 - 1 [default: the scenario's].
        trust: folders that the scenario may refer to, besides its own and the working folder.
        record: samples per second, 1 to 100000.

    Returns:
        The recording: time in s since the brake command, units of every channel in `units`. Of a case that
        repeats its stop, the first.

    Raises:
        uictest.ScenarioErrors: the file is invalid, or a key of `set`; the message has every error in it.
        ValueError: no such case, or several and none is named; or an argument is invalid.
        uictest.controllers.ControllerError: a controller from outside failed.

    """
    every = sample_interval("record", record)
    stop = rig.simulate(_case(what, case, set, checked_seed(seed), as_paths(trust)), every)
    assert stop.recording is not None  # a rate is requested
    return stop.recording


def _case(
    what: PathName | scenario.Case,
    case: str | None,
    assignments: Assignments | None,
    seed: int | None,
    trusted: list[Path],
) -> scenario.Case:
    texts = override_texts(assignments)
    if not isinstance(what, scenario.Case):
        return one_case(Path(what), case, texts, seed, trusted)
    if texts or trusted or case is not None:
        raise ValueError("case, set and trust apply to files: pass set and trust to uictest.load")
    if seed is None:
        return what
    return replace(what, scenario=what.scenario.model_copy(update={"seed": seed}))
