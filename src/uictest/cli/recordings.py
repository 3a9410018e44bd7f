"""Options and steps that the commands for recordings share."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, TypeVar

import typer

from uictest import field_data, scenario
from uictest.cli.cases import load_cases, select_by_options
from uictest.cli.exit_codes import InvalidInputError
from uictest.recording import formats
from uictest.scenario import yaml

Files = Annotated[list[Path], typer.Argument(metavar="FILE...", help="Recordings.", show_default=False)]
MapName = Annotated[
    str,
    typer.Option(
        "--map", metavar="NAME|FILE", help="Channel map: a preset (uictest, common-names) or a YAML file."
    ),
]
Trigger = Annotated[
    str | None,
    typer.Option(
        "--trigger",
        metavar="HOW|TIME",
        help="Brake command at: auto, stated, start, command, demand, pressure, or a time such as '12.3 s'.",
    ),
]
TriggerLead = Annotated[
    str | None,
    typer.Option("--trigger-lead", metavar="TIME", help="Time from the brake command to the trigger."),
]
Raster = Annotated[
    str | None, typer.Option("--raster", metavar="TIME", help="Interval to which the samples are resampled.")
]
LowPass = Annotated[
    str | None,
    typer.Option(
        "--low-pass",
        metavar="FREQUENCY",
        help="Low-pass filter for every signal, such as '10 Hz'.",
    ),
]
Result = TypeVar("Result")
_UNSAFE = re.compile(r"[^A-Za-z0-9._-]+")
_LONGEST_NAME = 80


def channel_map(
    reference: str, trusted: Sequence[Path] | None, **preparation: str | None
) -> tuple[field_data.ChannelMap, dict[str, str]]:
    """Return a channel map, its preparation changed by options, and the files read for it.

    Raises InvalidInputError where there is no such map, typer.BadParameter for an option that does not fit.
    """
    try:
        loaded, inputs = field_data.load_map(reference, trusted or ())
    except KeyError:
        known = ", ".join(field_data.presets())
        raise InvalidInputError(
            f"uictest: no channel map {reference!r}: name a preset ({known}) or a .yaml file"
        ) from None
    except yaml.ScenarioErrors as errors:
        raise InvalidInputError(str(errors)) from errors
    changed = _with_options(loaded.preparation, preparation)
    return loaded.model_copy(update={"preparation": changed}), inputs


def _with_options(
    preparation: field_data.Preparation, texts: dict[str, str | None]
) -> field_data.Preparation:
    """Return the preparation with the options that are set. Raises typer.BadParameter."""
    from pydantic import ValidationError

    options = {name: text for name, text in texts.items() if text is not None}
    if (trigger := options.get("trigger")) is not None and any(map(str.isdigit, trigger)):
        options["trigger_time"] = options.pop("trigger")
    try:
        return field_data.Preparation.model_validate({**dict(preparation), **options})
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        name = str(first["loc"][0]) if first["loc"] else ""
        option = f"--{name.removesuffix('_time').replace('_', '-')}"
        raise typer.BadParameter(str(first["msg"]), param_hint=option) from error


def one_case(
    path: Path, expression: str | None, overrides: Sequence[str], trusted: Sequence[Path] | None
) -> scenario.Case:
    """Return the one case of a scenario file. Raises InvalidInputError where there are several or none."""
    cases = select_by_options(load_cases([path], overrides, None, trusted), expression, None)
    if len(cases) != 1:
        ids = ", ".join(case.id for case in cases[:8]) or "none is selected"
        raise InvalidInputError(
            f"uictest: {path} has {len(cases)} cases where one is needed ({ids}); choose with -k"
        )
    return cases[0]


def each_file(paths: Sequence[Path], use: Callable[[Path], Result]) -> list[Result]:
    """Apply `use` to every file, and return its results.

    Raises InvalidInputError with every file's error, ReadingInterruptedError where reading was cut off.
    """
    results: list[Result] = []
    errors: list[str] = []
    for path in paths:
        try:
            results.append(use(path))
        except (formats.UnreadableError, formats.MissingExtraError, field_data.MapError) as error:
            errors.append(f"uictest: {path}: {error}")
        except formats.ReadingInterruptedError:
            raise  # not an error of the file
        except OSError as error:
            errors.append(f"uictest: {path}: {error.strerror or error}")
    if errors:
        raise InvalidInputError("\n".join(errors))
    return results


def stop_names(paths: Sequence[Path]) -> list[str]:
    """Return a name for each file, safe as a file name and all different."""
    names: list[str] = []
    for path in paths:
        stem = _UNSAFE.sub("-", path.stem).strip("-.")[:_LONGEST_NAME].lower() or "recording"
        name = next(
            n for k in range(1, len(paths) + 1) if (n := stem if k == 1 else f"{stem}-{k}") not in names
        )
        names.append(name)
    return names
