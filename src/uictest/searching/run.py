"""A search from its scenario to its folder: the file of stops, the cases found, and their page."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from uictest import __version__, controllers, rig, runs
from uictest.core import files
from uictest.plans.search import Space
from uictest.running import campaign
from uictest.searching.engine import Engine, Progress
from uictest.searching.outcome import SCHEMA, SearchOutcome, shrunk_cases
from uictest.searching.trials import Trials

STOPS: Final = "search.csv"
RESULT: Final = "search.json"


@dataclass(frozen=True)
class SearchRequest:
    """A search to run.

    Args:
        space: that is searched.
        folder: for the files; None: none are written.
        jobs: number of threads.
        resume: whether the folder holds a search that was interrupted, which goes on.
        guided: whether half of the stops follow the margins.
        in_process: whether controllers from outside run in this process, which they can then crash.
        arguments: of the command line.

    """

    space: Space
    folder: Path | None = None
    jobs: int = 1
    resume: bool = False
    guided: bool = True
    in_process: bool = False
    arguments: Sequence[str] = ()


def run_search(request: SearchRequest, progress: Progress, observer: runs.Observer) -> SearchOutcome:
    """Search, make what was found small, and write the files.

    Raises InvalidInputError where the folder is in use, to resume, is of another search, or stops that failed
    do not fail again; OSError, and KeyboardInterrupt: the stops that are finished are kept.
    """
    space = request.space
    rig.compiled_rig()
    # What controllers print in thousands of stops is dropped; the run of the found cases keeps it.
    with _folder(request) as file, rig.Workers(keep_output=True) as workers:
        try:
            run_block = rig.run_block if request.in_process else workers.run_block
            engine = Engine(Trials(space, request.jobs, run_block, file), progress, request.guided)
            findings = engine.run()
            stops = engine.trials.simulated
            cases = shrunk_cases(engine, request.folder or Path())
        except KeyboardInterrupt:
            controllers.interrupt_turns()
            raise
        more = engine.trials.simulated - stops
        outcome = SearchOutcome(space.name, space.search.criteria, tuple(cases), findings, stops, more)
        return outcome if request.folder is None else _published(outcome, request, request.folder, observer)


def _digest(space: Space) -> str:
    """Return a digest of all that decides which stops a search runs, and what they come to."""
    case = space.loaded.case
    parts = __version__, space.search.model_dump_json(), case.scenario.model_dump_json(), case.inputs
    return hashlib.sha256(repr(parts).encode()).hexdigest()


@contextmanager
def _folder(request: SearchRequest) -> Iterator[Path | None]:
    """Lend the file of stops in the folder, which is locked. Raises InvalidInputError, OSError."""
    if request.folder is None:
        yield None
        return
    begun = {"schema": SCHEMA, "search": _digest(request.space)}
    result, stops = request.folder / RESULT, request.folder / STOPS
    if request.resume and not result.is_file():
        raise runs.InvalidInputError(f"--resume: {request.folder} holds no search: it has no {RESULT}")
    with runs.locked_folder(request.folder):
        if not request.resume:
            files.write_to(stops, "")
            files.write_to(result, json.dumps(begun) + "\n")
        document = None
        with suppress(ValueError):
            document = json.loads(result.read_text("utf-8"))
        if not isinstance(document, dict) or not begun.items() <= document.items():
            text = "holds another search, or uictest, the scenario or a file that it reads has changed since"
            raise runs.InvalidInputError(f"--resume: {request.folder} {text}")
        yield stops


def _published(
    outcome: SearchOutcome, request: SearchRequest, folder: Path, observer: runs.Observer
) -> SearchOutcome:
    """Write the cases, run them with the page of a run, and write the outcome."""
    outcome = replace(outcome, folder=folder)
    paths = [folder / f"found-{number}.yaml" for number in range(1, len(outcome.found) + 1)]
    for path, case in zip(paths, outcome.found, strict=True):
        files.write_to(path, case.text)
    if paths:
        trusted = [request.space.loaded.case.path.parent, *request.space.trusted]
        # On the page what was found are failures: that each file expects its own is for later runs.
        cases = runs.load_cases(paths, ["expect=pass"], None, trusted)
        settings = campaign.RunSettings(request.jobs, in_process=request.in_process)
        batch = runs.batch_of(cases, (), request.arguments, None, settings)
        published = runs.publish_batch(batch, folder, ("csv", "html"), observer)
        if published is None or published.interrupted:
            raise KeyboardInterrupt
        outcome = replace(outcome, page=published.place / "index.html")
    document = {**outcome.document(), "search": _digest(request.space)}
    files.write_to(folder / RESULT, json.dumps(document, indent=2, default=str) + "\n")
    return outcome
