"""A search from its scenario to its folder: the file of stops, the cases found, and their page."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain, count
from pathlib import Path
from typing import Final

from uictest import controllers, rig, runs
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
        path: of the scenario, as the user named it.
        folder: for the files; None: none are written.
        jobs: number of threads.
        resume: whether the folder holds a search that was interrupted, which goes on.
        guided: whether half of the stops follow the margins.
        in_process: whether controllers from outside run in this process, which they can then crash.
        arguments: of the command line.
        trusted: folders that scenarios may refer to.

    """

    space: Space
    path: Path
    folder: Path | None = None
    jobs: int = 1
    resume: bool = False
    guided: bool = True
    in_process: bool = False
    arguments: Sequence[str] = ()
    trusted: Sequence[Path] = ()


def new_folder(output: Path, space: Space) -> Path:
    """Return the folder of a new search below `output`: the first name that nothing has."""
    name = f"{space.loaded.case.scenario.name}-search"
    taken = {path.name for path in output.iterdir()} if output.is_dir() else set[str]()
    return output / next(
        each for each in chain([name], (f"{name}-{n}" for n in count(2))) if each not in taken
    )


def run_search(request: SearchRequest, progress: Progress, observer: runs.Observer) -> SearchOutcome:
    """Search, make what was found small, and write the files.

    Raises InvalidInputError where the folder to resume is of another search, OSError, and KeyboardInterrupt:
    the stops that are finished are kept.
    """
    space = request.space
    rig.compiled_rig()
    _begin_folder(request)
    file = None if request.folder is None else request.folder / STOPS
    with rig.Workers() as workers:
        try:
            run_block = rig.run_block if request.in_process else workers.run_block
            try:
                trials = Trials(space, request.jobs, run_block, file)
            except ValueError as error:
                raise runs.InvalidInputError(str(error)) from error
            findings = Engine(trials, progress, request.guided).run()
            stops = trials.simulated
            cases = shrunk_cases(trials, findings, request.path, request.folder or Path())
        except KeyboardInterrupt:
            controllers.interrupt_turns()
            raise
    criteria = space.search.criteria
    name = space.loaded.case.scenario.name
    outcome = SearchOutcome(name, criteria, tuple(cases), findings, stops, trials.simulated, request.folder)
    return outcome if request.folder is None else _published(outcome, request, request.folder, observer)


def _digest(space: Space) -> str:
    """Return a digest of all that decides which stops a search runs."""
    section = space.search.model_dump_json()
    text = f"{section}\n{space.loaded.case.scenario.model_dump_json()}"
    return hashlib.sha256(text.encode()).hexdigest()


def _begin_folder(request: SearchRequest) -> None:
    """Make the folder, or see whether it is that of this search. Raises InvalidInputError, OSError."""
    if request.folder is None:
        return
    result, digest = request.folder / RESULT, _digest(request.space)
    if not request.resume:
        files.make_folder(request.folder)
        files.write_to(result, json.dumps({"schema": SCHEMA, "search": digest}) + "\n")
        return
    try:
        document = json.loads(result.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise runs.InvalidInputError(f"--resume: {request.folder} holds no search: {error}") from error
    if not isinstance(document, dict) or document.get("search") != digest:
        text = f"--resume: {request.folder} holds another search, or the scenario has changed since"
        raise runs.InvalidInputError(text)


def _published(
    outcome: SearchOutcome, request: SearchRequest, folder: Path, observer: runs.Observer
) -> SearchOutcome:
    """Write the cases, run them with the page of a run, and write the outcome."""
    paths = [folder / f"found-{number}.yaml" for number in range(1, len(outcome.found) + 1)]
    for path, case in zip(paths, outcome.found, strict=True):
        files.write_to(path, case.text)
    if paths:
        trusted = [request.path.parent, *request.trusted]
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
