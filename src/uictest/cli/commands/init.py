"""`uictest init`: a first scenario or a first controller to start from."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from uictest import report, runs
from uictest.cli.commands.schema import SchemaKind, schemas_below
from uictest.cli.options import argument, option
from uictest.cli.output import ExitCode, message
from uictest.core import files
from uictest.plans import library, templates

SCENARIO = Path("scenarios", "first-stop.yaml")

_FIRST_STOP = """\
# yaml-language-server: $schema=../schema/scenario.schema.json
schema: uictest/scenario/1
name: first-stop
title: Full service stop from 120 km/h on a dry rail, brake position R
tags: [first]
vehicle: intercity-180        # `uictest library list` shows what can be named here
initial_speed: 120 km/h
brake:
  command: 100 %
  position: R
rail:
  condition: dry
rig:
  topology: one-caliper       # one real caliper, three tanks with computed force
  compensation: thermal
  wsp: active
criteria: uictest-stop
expect: pass
"""
CONTROLLER = "controller"
"""What to write instead of a first scenario."""

What = Annotated[
    Path,
    argument(
        "DIR|controller", "Folder for scenarios/ and schema/; or the word controller, with --python or --c."
    ),
]
PythonFolder = Annotated[
    Path | None, option("--python DIR", "Write a first WSP controller in Python to DIR.")
]
Shipped = Annotated[
    bool, option("--scenarios", "Copy the scenarios, sweeps and series that ship with uictest.")
]
CFolder = Annotated[Path | None, option("--c DIR", "Write a first WSP controller in C to DIR.")]


def init(
    what: What = Path(), python: PythonFolder = None, c: CFolder = None, shipped: Shipped = False
) -> ExitCode:
    """Write a first scenario, and the schema with which editors complete it.

    Overwrites nothing but its own schemas.

    With --scenarios, copies of those that ship stand in place of it. With the word controller: write a first
    WSP controller, its part and a scenario that runs it.
    """
    if what == Path(CONTROLLER):
        if shipped:
            raise typer.BadParameter("write `uictest init --scenarios` without the word controller")
        if python is not None and c is None:
            _write_controller(python, "python")
        elif c is not None and python is None:
            _write_controller(c, "c", f"make -C {report.argument(str(c))}")
        else:
            raise typer.BadParameter("write `uictest init controller` with either --python DIR or --c DIR")
        return ExitCode.MET
    if python is not None or c is not None:
        raise typer.BadParameter("write `uictest init controller` with --python or --c")
    if shipped:
        paths = library.scenarios().values()
        copies = {what / "scenarios" / path.name: path.read_text("utf-8") for path in paths}
        _write_new(
            copies,
            schemas_below(what / "schema", SchemaKind.SCENARIO, SchemaKind.SERIES, SchemaKind.PROGRAMME),
        )
        message(f"Run them with 'uictest run {report.argument(str(what / 'scenarios'))}'.")
    else:
        _write_new({what / SCENARIO: _FIRST_STOP}, schemas_below(what / "schema", SchemaKind.SCENARIO))
        message(f"Run it with 'uictest run {report.argument(str(what / SCENARIO))}'.")
    return ExitCode.MET


def _write_controller(folder: Path, language: templates.Language, *build: str) -> None:
    """Write a first controller, and show what to do with it."""
    _write_new({folder / name: text for name, text in templates.controller_files(language).items()})
    part, stop = (report.argument(str(folder / name)) for name in ("my-wsp.yaml", "slip-120.yaml"))
    check, run = f"uictest controller check {part}", f"uictest run {stop}"
    message("\n".join(["Next:", *(f"    {command}" for command in (*build, check, run))]))


def _write_new(texts: Mapping[Path, str], schemas: Mapping[Path, str] | None = None) -> None:
    """Write files that do not exist yet, and schemas, which are replaced.

    Raises InvalidInputError where one of the files exists, WriteError; then none is written.
    """
    existing = [path for path in texts if os.path.lexists(path)]
    if existing:
        raise runs.InvalidInputError(f"already there: {', '.join(map(str, existing))}")
    written = {**texts, **(schemas or {})}
    files.write_all(written)
    message(f"uictest: wrote {', '.join(map(str, written))}")
