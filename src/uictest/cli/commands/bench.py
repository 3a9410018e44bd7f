"""`uictest bench`: the caliper without vehicle, under pressures and valve commands of a recipe."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from uictest import identification
from uictest.cli.exit_codes import ExitCode, InvalidInputError
from uictest.cli.options import Trusted, Verbosity
from uictest.cli.output import data, message
from uictest.cli.progress import announce_compilation
from uictest.scenario import yaml

if TYPE_CHECKING:
    from uictest.recording import Recording
    from uictest.rig.bench import BenchTest


def bench(
    recipe: Annotated[
        str | None,
        typer.Argument(
            metavar="[RECIPE]", help="A recipe of the library or a .yaml file.", show_default=False
        ),
    ] = None,
    trace: Annotated[
        Path | None,
        typer.Option("--trace", metavar="FILE", help="Demand a recorded pressure instead of a recipe's."),
    ] = None,
    pressure: Annotated[
        str,
        typer.Option("--pressure", metavar="CHANNEL", help="Channel of the demanded pressure in --trace."),
    ] = "demanded_pressure",
    command: Annotated[
        str | None,
        typer.Option("--command", metavar="CHANNEL", help="Channel of the valve command in --trace."),
    ] = None,
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Set a key of the rig. May be repeated."),
    ] = None,
    seed: Annotated[
        int | None, typer.Option("--seed", min=0, max=2**32 - 1, help="Seed of the noise.")
    ] = None,
    trusted: Trusted = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Recording to write, .parquet or .csv [default: RECIPE.parquet].",
            show_default=False,
        ),
    ] = None,
    listed: Annotated[bool, typer.Option("--list", help="List the recipes of the library.")] = False,
    quiet: Annotated[
        bool, typer.Option("-q", "--quiet", help="Write the recording and show nothing.")
    ] = False,
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Test the caliper on the bench. Writes a recording of pressures, forces, stroke and commands."""
    from uictest.rig.bench import is_compiled, loading as bench_loading

    if listed:
        data("\n".join(bench_loading.recipe_names()))
        return ExitCode.MET
    test = _test(recipe, trace, pressure, command, overrides or (), seed, trusted or ())
    target = output or Path(f"{test.recipe.name}.parquet")
    writer = _writer(target)
    announce_compilation(warm=is_compiled(), quiet=quiet)
    recording = _run(test)
    writer(recording, target)
    if not quiet:
        message(f"uictest: wrote {len(recording)} samples of {recording['time'][-1]:.1f} s to {target}")
        data(_summary(recording))
    return ExitCode.MET


def _test(
    recipe: str | None,
    trace: Path | None,
    pressure: str,
    command: str | None,
    overrides: list[str] | tuple[()],
    seed: int | None,
    trusted: Sequence[Path],
) -> BenchTest:
    from uictest.rig.bench import load_bench, recipe_names, recipe_path, trace_recipe

    if (recipe is None) == (trace is None):
        raise InvalidInputError(
            f"uictest: name one recipe ({', '.join(recipe_names())}, or a .yaml file) or give --trace FILE"
        )
    try:
        if trace is not None:
            return trace_recipe(trace, pressure, command, overrides, seed, trusted)
        assert recipe is not None
        if not recipe_path(recipe).exists():
            hint = yaml.suggestion(recipe, recipe_names())
            raise InvalidInputError(f"uictest: no bench recipe {recipe!r}; {hint}")
        return load_bench(recipe_path(recipe), overrides, seed, trusted)
    except yaml.ScenarioErrors as errors:
        raise InvalidInputError(str(errors)) from errors


def _run(test: BenchTest) -> Recording:
    from uictest.rig.bench import run_test

    try:
        return run_test(test)
    except identification.UnsuitableRecordError as error:
        raise InvalidInputError(f"uictest: {error}") from error
    except FileNotFoundError as error:
        raise InvalidInputError(f"uictest: {error.filename}: no such file") from error


def _writer(target: Path):  # type: ignore[no-untyped-def]
    from uictest.recording.formats import writer_of

    formats = {".parquet": "parquet", ".csv": "csv"}
    if target.suffix.lower() not in formats:
        raise InvalidInputError(f"uictest: {target}: write a .parquet or a .csv file")
    if not target.parent.is_dir():
        raise InvalidInputError(f"uictest: {target}: there is no folder {target.parent}")
    return writer_of(formats[target.suffix.lower()])


def _summary(recording: Recording) -> str:
    """Largest errors of the computed forces and pressures, in per cent of the largest measured ones."""
    import numpy as np

    def error(computed: str, measured: str) -> float:
        difference = np.abs(recording[computed] - recording[measured]).max()
        return float(100.0 * difference / max(recording[measured].max(), 1e-9))

    force, pressure = "clamping_force_1", "cylinder_pressure_1"
    rows = [
        ("force computed from module 1, hysteresis", error("computed_force_1", force)),
        *(
            (f"force computed from module 2, {name}", error(f"computed_force_{name}_2", force))
            for name in ("none", "hysteresis", "cylinder", "full")
        ),
        ("pressure of module 2 as it is", error("measured_pressure_2", pressure)),
        ("pressure of module 2, cylinder dynamics", error("cylinder_pressure_2", pressure)),
    ]
    lines = [f"{name:<42}{value:8.2f} %" for name, value in rows]
    return "\n".join(["largest error against module 1, of the largest measured value", *lines])
