"""Search for stops in which a WSP fails."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from uictest import runs, searching
from uictest.api.arguments import (
    Assignments,
    PathName,
    Trusted,
    as_paths,
    checked_seed,
    override_texts,
    thread_count,
)
from uictest.core import files
from uictest.plans.search import load_search


def search(
    file: PathName,
    *,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    seed: int | None = None,
    stops: int | None = None,
    trust: Trusted = (),
    jobs: int | Literal["auto"] = "auto",
    output: PathName | None = None,
    resume: PathName | None = None,
) -> searching.SearchOutcome:
    """Search for stops in which a WSP fails, as `uictest search` does.

    Nothing is printed, and nothing is written unless `output` or `resume` names a folder. Ctrl-C raises
    KeyboardInterrupt.

    Args:
        file: scenario with the section `search`.
        set: dotted key -> value, as for :func:`uictest.load`.
        seed: seed of the points, in place of the section's, 0 to 2^32 - 1.
        stops: stops to simulate, in place of the section's.
        trust: folders that the scenario may refer to, besides its own and the working folder.
        jobs: number of threads, `auto`: one for each processor; the result does not depend on it.
        output: folder in which the search gets a folder.
        resume: folder of a search that was interrupted, which goes on.

    Returns:
        The outcome: `found` holds the cases with their `sentence`, `values` and `text` (the scenario), empty
        where none was found; `lines` the answer in words; `folder` and `page` the files.

    Raises:
        uictest.ScenarioErrors: the file is invalid, or a key of `set`; the message has every error in it.
        ValueError: an argument is invalid, `resume` holds another search, or stops that failed do not fail
            again.
        OSError: the results cannot be written.

    """
    if stops is not None and stops < 16:
        raise ValueError(f"stops: at least 16 are needed, not {stops}")
    path, folders = Path(file), as_paths(trust)
    space = load_search(path, tuple(override_texts(set)), checked_seed(seed), folders, stops)
    folder = None if resume is None else Path(resume)
    if folder is None and output is not None:
        folder = files.new_folder(Path(output), f"{space.name}-search")
    request = searching.SearchRequest(space, folder, thread_count(jobs), resume=resume is not None)
    return searching.run_search(request, lambda stops, margin: None, runs.Observer())
