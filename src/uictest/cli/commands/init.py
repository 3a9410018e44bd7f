"""`uictest init`: a first scenario to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from uictest import recording
from uictest.cli.commands.schema import schema_text
from uictest.cli.exit_codes import ExitCode, InvalidInputError
from uictest.cli.options import Verbosity
from uictest.cli.output import message

SCENARIO = Path("scenarios", "first-stop.yaml")
SCHEMA = Path("schema", "scenario.schema.json")

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
  compensation: full
  wsp: active
criteria: uictest-stop
expect: pass
"""


def init(
    folder: Annotated[Path, typer.Argument(help="Folder for scenarios/ and schema/.")] = Path(),
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Write a first scenario, and the schema with which editors complete it. Overwrites nothing."""
    texts = {folder / SCENARIO: _FIRST_STOP, folder / SCHEMA: schema_text()}
    existing = [path for path in texts if path.exists()]
    if existing:
        raise InvalidInputError(f"uictest: already there: {', '.join(map(str, existing))}")
    _write(texts)
    message(f"uictest: wrote {', '.join(map(str, texts))}")
    message(f"Run it with 'uictest run {folder / SCENARIO}'.")
    return ExitCode.MET


def _write(texts: dict[Path, str]) -> None:
    for path, text in texts.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        recording.write_text_atomic(path, text)
