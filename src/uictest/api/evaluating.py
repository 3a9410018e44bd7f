"""Judge recorded stops."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from uictest import runs
from uictest.api.arguments import (
    Assignments,
    PathName,
    Record,
    Trusted,
    as_paths,
    command_words,
    expression_of,
    override_texts,
    recording_request,
)
from uictest.api.results import Results
from uictest.plans import scenario as scenarios

_ARGUMENTS = {
    "rail.condition": "rail",
    "brake.position": "position",
    "rig.wsp": "wsp",
    "criteria": "criteria",
}
"""Key that must be stated for a recording -> the argument that states it."""
_FORMATS = ("html",)
DEFAULT_MAP = "uictest"


def evaluate(
    files: PathName | Iterable[PathName],
    *,
    scenario: PathName | scenarios.Case | None = None,
    select: str | None = None,
    criteria: str | Sequence[str] | None = None,
    rail: str | None = None,
    position: str | None = None,
    wsp: str | None = None,
    channel_map: PathName = DEFAULT_MAP,
    trigger: str | None = None,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    trust: Trusted = (),
    record: Record = "failed",
    strict: bool = False,
    output: PathName | None = None,
) -> Results:
    """Judge recordings of real or simulated stops: the same digits as `uictest evaluate`.

    A recording does not contain what was tested: state it with `scenario`, or with `criteria`, `rail`,
    `position` and `wsp`.

    Args:
        files: recordings; or `*.series.yaml` files whose stops name recordings.
        scenario: file with the test conditions and the criteria, or a case from :func:`uictest.load`.
        select: expression that selects one case of the scenario file, as `-k`.
        criteria: names of criteria to judge by, one or several.
        rail: rail condition, such as `wet`.
        position: brake position, such as `R`.
        wsp: `active` or `bypassed`.
        channel_map: a preset or a YAML file.
        trigger: the brake command, as `--trigger`: `auto`, `start`, ... or a time such as `12.3 s`.
        set: dotted key -> value, as for :func:`uictest.load`.
        trust: folders that files may refer to, besides their own and the working folder.
        record: samples that `output` gets: of stops `failed` (not as expected), of `all` or `none`.
        strict: whether a stop is met only if all of its verdicts are settled, too, as `--strict`.
        output: folder for reports; the run gets a folder in it, as with `-o`.

    Returns:
        One result per recording, named after its file; :meth:`Results.recording` has the samples that it was
        judged by.

    Raises:
        uictest.ScenarioErrors: the scenario, the channel map or the series is invalid.
        ValueError: a recording cannot be read, a statement is missing, or an argument is invalid.
        OSError: reports cannot be written.

    """
    paths, folders, request = as_paths(files), as_paths(trust), recording_request(record)
    if not paths:
        raise ValueError("nothing to evaluate: name recordings")
    stated = _statements([criteria] if isinstance(criteria, str) else criteria, rail, position, wsp)
    statements, overrides = list(stated), override_texts(set)
    options = {
        "--scenario": scenario.path if isinstance(scenario, scenarios.Case) else scenario,
        "-k": select,
        "--set": [*statements, *overrides],
        "--trust": folders,
        "--map": None if channel_map == DEFAULT_MAP else channel_map,
        "--trigger": trigger,
        "--record": None if record == "failed" else record,
        "-o": output,
    }
    words = command_words(["evaluate", *paths, *(["--strict"] if strict else [])], options)

    def conditions() -> runs.Conditions:
        case_of = _case_of(scenario, select, [*statements, *overrides], folders)
        mapped, inputs = runs.named_map(str(channel_map), folders)
        return runs.Conditions(runs.triggered_map(mapped, trigger), inputs, case_of)

    said = (scenario, select, *statements, trigger)
    batch, _ = runs.recorded_batch(
        paths, words, conditions, overrides, folders, stated=said, option="set", strict=strict
    )
    content, recordings = runs.judge_recordings(batch)
    if output is None:
        return Results(content, recordings=recordings)
    wanted = request.among(recordings, content.all_results)
    published = runs.publish_run(content, wanted, Path(output), _FORMATS)
    return Results(published.content, recordings=recordings, folder=published.place)


def _case_of(
    scenario: PathName | scenarios.Case | None,
    select: str | None,
    statements: Sequence[str],
    trusted: Sequence[Path],
) -> runs.CaseOfStop:
    """Return the function that makes the case of a recording. Raises ValueError."""
    if isinstance(scenario, scenarios.Case):
        if statements or select is not None:
            raise ValueError("a case is judged as it is: state its conditions in uictest.load")
        return lambda name, speed: scenario
    case = None
    if scenario is not None:
        with expression_of("select", select):
            case = runs.only_case(Path(scenario), select, statements, trusted, "choose with select=")
    return runs.case_of_stop(
        case,
        statements,
        trusted,
        lambda keys: f"scenario=, or with {', '.join(f'{_ARGUMENTS[key]}=' for key in keys)}",
    )


def _statements(
    criteria: Sequence[str] | None, rail: str | None, position: str | None, wsp: str | None
) -> Iterator[str]:
    """Yield what is stated of recordings in the form of `--set`."""
    listed = f"[{', '.join(criteria)}]" if criteria else None
    stated = {"rail.condition": rail, "brake.position": position, "rig.wsp": wsp, "criteria": listed}
    yield from (f"{key}={text}" for key, text in stated.items() if text is not None)
