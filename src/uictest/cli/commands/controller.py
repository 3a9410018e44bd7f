"""`uictest controller`: check a WSP controller without the rig."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from uictest.cli import options
from uictest.cli.commands.selftest import show_findings
from uictest.cli.entry import command
from uictest.cli.options import argument, option
from uictest.cli.output import ExitCode
from uictest.core import files
from uictest.plans import scenario
from uictest.plans.scenario import yaml
from uictest.selftest import conformance

controller = typer.Typer(rich_markup_mode=None, help="Check WSP controllers without the rig.")

Reference = Annotated[
    str,
    argument("FILE", "Part or scenario (.yaml), program (.py, .so, .dll, .fmu), tcp://HOST:PORT, or a name."),
]
ClassName = Annotated[str, option("--class NAME", "Class of a Python file [default: the one with a step].")]
Settings = Annotated[
    list[str] | None,
    option("--set NAME=VALUE", "Set a parameter of a controller from outside. May be repeated."),
]
TimeLimit = Annotated[
    float | None,
    option(
        "--time-limit SECONDS",
        "Longest time for one answer [default: that of the controller, 5 s].",
        min=0.001,
        max=600.0,
    ),
]


@command(controller, "check")
def check(
    reference: Reference,
    class_name: ClassName = "",
    settings: Settings = None,
    time_limit: TimeLimit = None,
    trusted: options.Trusted = None,
    junit: options.JUnitFile = None,
    page: Annotated[
        Path | None, option("--html FILE", "Also write a page, with plots of the situations it misses.")
    ] = None,
    shown: options.ListFormat = options.PlainFormat.TEXT,
) -> ExitCode:
    """Check that a controller keeps what every WSP should, in a child process and without the rig.

    It is driven through cycles with given speeds: a good rail, a sliding wheelset, locked ones, and random
    inputs. Exit code 1: it misses a check; 3: it crashed, hung or raised.
    """
    file = options.junit_file(junit, Path())
    if page is not None:
        files.require_place(page)
    subject = _subject(reference, class_name, settings or (), time_limit, trusted or ())
    examined = conformance.examined(subject)
    if page is not None:
        files.write_to(page, conformance.examination_html(*examined))
    return show_findings(examined.examination, shown, file)


def _subject(
    reference: str,
    class_name: str,
    settings: Sequence[str],
    time_limit: float | None,
    trusted: Sequence[Path],
) -> conformance.Subject:
    part = scenario.load_controller(reference, class_name, trusted)
    parameters = dict(map(_setting, settings))
    if part.program is None and (parameters or time_limit is not None):
        option = "--set" if parameters else "--time-limit"
        raise typer.BadParameter("for controllers from outside; this one is built in", param_hint=option)
    if parameters and isinstance(part, scenario.ExternalController):
        part = scenario.with_parameters(part, parameters)
    subject = conformance.subject_of(reference, part)
    if subject.program is None or time_limit is None:
        return subject
    return replace(subject, program=replace(subject.program, time_limit=time_limit))


def _setting(text: str) -> tuple[str, Any]:
    name, sign, value = text.partition("=")
    if not sign or not name.strip():
        raise typer.BadParameter(f"{text!r} is not NAME=VALUE", param_hint="--set")
    return name.strip(), yaml.scalar_value(value.strip())
