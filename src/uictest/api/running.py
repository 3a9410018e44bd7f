"""Run and judge scenarios, cases and series."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike
from pathlib import Path
from typing import Literal, NamedTuple

from uictest import report, runs
from uictest.api.arguments import (
    Assignments,
    PathName,
    Record,
    Trusted,
    as_paths,
    checked_seed,
    command_words,
    override_texts,
    recording_request,
    thread_count,
)
from uictest.api.loading import selected
from uictest.api.results import Results
from uictest.core import recording
from uictest.plans import scenario, series
from uictest.running import campaign

What = PathName | scenario.Case | Iterable[PathName | scenario.Case]
FORMATS = ("csv", "html")
DEFAULT_RATE = 100.0
"""Samples per second."""


def run(
    what: What | None = None,
    *,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    seed: int | None = None,
    repeat: int | None = None,
    select: str | None = None,
    tag: str | None = None,
    trust: Trusted = (),
    jobs: int | Literal["auto"] = "auto",
    record: Record = "failed",
    rate: float = DEFAULT_RATE,
    validated: PathName | None = None,
    strict: bool = False,
    output: PathName | None = None,
) -> Results:
    """Simulate and judge cases: the same digits as `uictest run`.

    Nothing is printed, and nothing is written unless `output` names a folder. Ctrl-C raises
    KeyboardInterrupt.

    Args:
        what: scenario files, `*.series.yaml` files or folders, one or several [default: the folder
            `scenarios`]; or one `*.programme.yaml`; or cases from :func:`uictest.load`.
        set: dotted key -> value or list of values in every scenario, as for :func:`uictest.load`.
        seed: seed of sensor noise and random rails in every case, 0 to 2^32 - 1.
        repeat: run the stop of every case so many times, 1 to 1000, under its seed and those that follow.
        select: expression over ids, file names and tags, as `-k`.
        tag: expression over tags, as `-m`.
        trust: folders that scenarios may refer to, besides their own and the working folder.
        jobs: number of threads, `auto`: one for each processor.
        record: cases to record: `failed` (not as expected), `all` or `none`.
        rate: samples per second of a recording.
        validated: validation.json of a validation: results outside of it are flagged, in place of what the
            scenarios name under `validated`.
        strict: whether a case or series is met only if all of its verdicts are settled, too, as `--strict`.
        output: folder for reports; the run gets a folder in it, as with `-o`.

    Raises:
        uictest.ScenarioErrors: files are invalid, or a key of `set`; the message has every error in it.
        ValueError: nothing is selected, or an argument is invalid.
        OSError: reports cannot be written.

    """
    request, threads = recording_request(record, rate), thread_count(jobs)
    texts, folders, seed = override_texts(set, repeat), as_paths(trust), checked_seed(seed)
    loaded = _loaded(what, texts, seed, folders)
    chosen, of_series = selected(loaded.cases, loaded.series, select, tag)
    options = {
        "--set": texts,
        "--seed": seed,
        "-k": select,
        "-m": tag,
        "--trust": folders,
        "--record": None if record == "failed" else record,
        "--record-rate": None if rate == DEFAULT_RATE else rate,
        "--validated": validated,
        "-o": output,
    }
    arguments = command_words([*loaded.words, *(["--strict"] if strict else [])], options)
    settings = campaign.RunSettings(threads, request, strict=strict)
    validation = None if validated is None else Path(validated)
    batch = runs.batch_of(chosen, of_series, arguments, seed, settings, validated=validation)
    batch = batch if loaded.programme is None else runs.of_programme(batch, loaded.programme)
    return _in_memory(batch) if output is None else _published(batch, Path(output))


class _Loaded(NamedTuple):
    """Cases and series, or a programme and its cases, and the words of a command line that runs them."""

    cases: Sequence[scenario.Case]
    series: Sequence[series.Series]
    words: Sequence[str]
    programme: series.Programme | None = None


def _loaded(what: What | None, texts: Sequence[str], seed: int | None, trusted: Sequence[Path]) -> _Loaded:
    """Return the cases and series to run. Raises ValueError, ScenarioErrors."""
    sources = [what] if isinstance(what, str | PathLike | scenario.Case) else list(what or ())
    if what is not None and not sources:
        raise ValueError("nothing to run: name files or give cases")
    names = [source for source in sources if not isinstance(source, scenario.Case)]
    cases = [source for source in sources if isinstance(source, scenario.Case)]
    programme = runs.load_programme(as_paths(names), texts, seed, trusted)
    if programme is not None and not cases:
        return _Loaded(programme.cases, (), ["run", *map(str, names)], programme)
    if not cases:
        cases, planned = runs.load_cases_and_series(as_paths(names), texts, seed, trusted)
        return _Loaded(cases, planned, ["run", *map(str, names)])
    if names:
        raise ValueError("name files or give cases, not both")
    if texts or seed is not None or trusted:
        raise ValueError("set, seed, repeat and trust apply to files: pass them to uictest.load")
    paths: dict[str, Path] = {}
    for case in cases:
        if case.id in paths:
            raise ValueError(f"two cases are called {case.id!r}, of {paths[case.id]} and {case.path}")
        paths[case.id] = case.path
    return _Loaded(cases, (), [report.CASES_IN_PYTHON, *dict.fromkeys(map(str, paths.values()))])


def _in_memory(batch: runs.Batch) -> Results:
    recordings: dict[str, recording.Recording] = {}
    done = runs.run_batch(batch, runs.Observer(), keep=recordings.__setitem__)
    if done.interrupted:
        raise KeyboardInterrupt
    return Results(
        done.content, recordings=recordings, cases=batch.all_cases, every=batch.settings.recording.every
    )


def _published(batch: runs.Batch, output: Path) -> Results:
    published = runs.publish_batch(batch, output, FORMATS, runs.Observer())
    if published is None or published.interrupted:
        raise KeyboardInterrupt
    return Results(published.content, folder=published.place)
