"""Compare recorded stops with their simulation."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from uictest import runs
from uictest.api.arguments import PathName, Trusted, as_paths, command_words, thread_count
from uictest.api.assignments import Assignments, override_texts
from uictest.api.validation_results import Validation


def validate(
    file: PathName,
    *,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    trust: Trusted = (),
    jobs: int | Literal["auto"] = "auto",
    output: PathName | None = None,
) -> Validation:
    """Compare recorded stops with their simulation: the same digits as `uictest validate`.

    Nothing is printed, and nothing is written unless `output` names a folder.

    Args:
        file: a validation file, or a `*.series.yaml` whose stops name recordings.
        set: dotted key -> value in every scenario, as for :func:`uictest.load`.
        trust: folders that files may refer to, besides their own and the working folder.
        jobs: number of threads, `auto`: one for each processor.
        output: folder for validations; this one gets a folder in it, as with `-o`.

    Raises:
        uictest.ScenarioErrors: the file is invalid, one that it names, or a key of `set`.
        ValueError: a recording cannot be read, no stop names one, the file has several series, or an argument
            is invalid.
        OSError: the files of the validation cannot be written.

    """
    threads, texts, folders = thread_count(jobs), override_texts(set), as_paths(trust)
    plan, *others = runs.load_validations([Path(file)], texts, folders)
    if others:
        names = ", ".join(each.name for each in (plan, *others))
        raise ValueError(f"{file}: each series is a validation of its own, found {names}: name a file of one")
    run = runs.run_validation(plan, threads, folders, runs.Observer())
    folder = None
    if output is not None:
        words = command_words(["validate", file], {"--set": texts, "--trust": folders, "-o": output})
        folder = runs.publish_validation(run.validation, words, Path(output))
    return Validation(run.validation, complete=run.complete, folder=folder)
