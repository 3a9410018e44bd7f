"""`--lf`: the cases that did not meet their expectation in the newest run."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import message

if TYPE_CHECKING:
    from uictest.scenario import Case


def failed_last(cases: Sequence[Case], output: Path) -> list[Case]:
    """Return the cases that failed last; all of them, with a message, where none is known to have failed.

    Raises InvalidInputError where the results of the newest run cannot be read.
    """
    from uictest.campaign import by_id
    from uictest.report import latest_run

    run = latest_run(output)
    if run is None:
        message(f"uictest: no earlier run in {output}: all cases are selected")
        return list(cases)
    selected = by_id(cases, _not_met(run))
    if not selected:
        message(f"uictest: none of these cases failed in {run.name}: all are selected")
    return selected or list(cases)


def _not_met(run: Path) -> frozenset[str]:
    from uictest.evaluation import results_of
    from uictest.report import RESULTS

    path = run / RESULTS
    try:
        results = results_of(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InvalidInputError(f"uictest: {path} cannot be read as the results of a run: {error}") from error
    return frozenset(result.id for result in results if not result.met)
