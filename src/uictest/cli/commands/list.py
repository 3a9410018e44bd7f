"""`uictest list`: the ids of cases."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from uictest.cli import sweep as sweeping
from uictest.cli.cases import (
    case_lines,
    case_table,
    cases_json,
    load_cases,
    nothing_selected,
    select_by_options,
)
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Expression, ListFormat, Overrides, Paths, PlainFormat, Tag, Trusted, Verbosity
from uictest.cli.output import data, message, terminal_width


def list_cases(
    paths: Paths = None,
    expression: Expression = None,
    tag: Tag = None,
    overrides: Overrides = None,
    trusted: Trusted = None,
    shown: ListFormat = PlainFormat.TEXT,
    verbosity: Verbosity = 0,
) -> ExitCode:
    """List the ids of all cases, one per line; with -v, titles and tags. Sweeps must be named."""
    if paths and all(map(sweeping.is_sweep, paths)):
        return _list_sweeps(paths, expression, overrides, trusted)
    cases = load_cases(paths, overrides, None, trusted)
    selected = select_by_options(cases, expression, tag)
    if not selected:
        message(nothing_selected(cases))
        return ExitCode.NOTHING_SELECTED
    width = terminal_width(sys.stdout)
    if shown is PlainFormat.JSON:
        data(cases_json(selected))
    elif verbosity and width is not None:
        data("\n".join(case_table(selected, width)))
    else:
        data(case_lines(selected, described=verbosity > 0))
    return ExitCode.MET


def _list_sweeps(
    paths: Sequence[Path],
    expression: str | None,
    overrides: Sequence[str] | None,
    trusted: Sequence[Path] | None,
) -> ExitCode:
    selections = [
        sweeping.selected_cases(sweeping.load_plan(path, overrides, None, trusted), expression)
        for path in paths
    ]
    for selection in selections:
        if not sweeping.show_ids(selection):
            break
    if any(selection.size for selection in selections):
        return ExitCode.MET
    message("uictest: nothing selected")
    return ExitCode.NOTHING_SELECTED
