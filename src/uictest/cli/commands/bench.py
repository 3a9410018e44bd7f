"""`uictest bench`: test the caliper alone under the pressures and valve commands of a recipe."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from uictest import runs
from uictest.cli.options import argument, option, trusted_folders
from uictest.cli.output import ExitCode, data, message
from uictest.core import files, recording
from uictest.core.recording import formats
from uictest.plans import scenario
from uictest.plans.scenario import yaml
from uictest.rig import bench as rig_bench, identification

_FORMATS = {".parquet": "parquet", ".csv": "csv"}
"""Suffix of the recording -> its format."""

Recipe = Annotated[
    str | None,
    argument(
        "RECIPE", "Recipe of the library, in 'uictest library list', or a .yaml file.", show_default=False
    ),
]
TraceFile = Annotated[
    Path | None, option("--trace FILE", "Recording whose pressure is demanded, instead of RECIPE.")
]
PressureChannel = Annotated[str, option("--pressure CHANNEL", "Channel of the demanded pressure in --trace.")]
CommandChannel = Annotated[
    str | None, option("--command CHANNEL", "Channel of the valve command in --trace.")
]
RigOverrides = Annotated[
    list[str] | None, option("--set KEY=VALUE", "Set a key of the rig. May be repeated.")
]
Output = Annotated[
    Path | None,
    option(
        "-o --output FILE",
        "Recording to write, .parquet or .csv [default: RECIPE.parquet].",
        show_default=False,
    ),
]


def bench(
    recipe: Recipe = None,
    trace: TraceFile = None,
    pressure: PressureChannel = "demanded_pressure",
    command: CommandChannel = None,
    overrides: RigOverrides = None,
    output: Output = None,
) -> ExitCode:
    """Test the caliper on the bench. Writes a recording of pressures, forces, stroke and commands."""
    test = _test(recipe, trace, pressure, command, overrides or ())
    target = output or Path(f"{test.recipe.name}.parquet")
    if target.suffix.lower() not in _FORMATS:
        raise runs.InvalidInputError(f"{target}: write a .parquet or a .csv file")
    files.require_place(target)
    try:
        samples = rig_bench.run_test(test)
    except identification.UnsuitableRecordError as error:
        raise runs.InvalidInputError(f"{error}") from error
    except FileNotFoundError as error:
        raise runs.InvalidInputError(f"{error.filename}: no such file") from error
    formats.writer_of(_FORMATS[target.suffix.lower()])(samples, target)
    message(f"uictest: wrote {len(samples)} samples of {samples['time'][-1]:.1f} s to {target}")
    data(_summary(samples))
    return ExitCode.MET


def _test(
    recipe: str | None, trace: Path | None, pressure: str, command: str | None, overrides: Sequence[str]
) -> rig_bench.BenchTest:
    """Return the test of a recipe or of a recorded pressure. Raises InvalidInputError."""
    names = rig_bench.recipe_names()
    if (recipe is None) == (trace is None):
        raise runs.InvalidInputError(
            f"name one recipe ({', '.join(names)}, or a .yaml file) or give --trace FILE"
        )
    if trace is not None:
        return rig_bench.trace_recipe(trace, pressure, command, overrides, None, trusted_folders())
    assert recipe is not None
    if not os.path.exists(rig_bench.recipe_path(recipe)):  # noqa: PTH110 - Path.exists raises for long names
        hint = yaml.suggestion(recipe, names)
        raise runs.InvalidInputError(f"no bench recipe {recipe!r}; {hint}")
    return rig_bench.load_bench(rig_bench.recipe_path(recipe), overrides, None, trusted_folders())


def _summary(samples: recording.Recording) -> str:
    """Return the largest errors of the computed forces and pressures, in % of the largest measured value."""
    import numpy as np

    def error(computed: str, measured: str) -> float:
        difference = np.abs(samples[computed] - samples[measured]).max()
        return float(100.0 * difference / max(samples[measured].max(), 1e-9))

    force, pressure = "clamping_force_1", "cylinder_pressure_1"
    rows = [
        ("force computed from module 1, hysteresis", error("computed_force_1", force)),
        *(
            (f"force computed from module 2, {name}", error(f"computed_force_{name}_2", force))
            for name in scenario.COMPENSATION_SETTINGS
        ),
        ("pressure of module 2 as it is", error("measured_pressure_2", pressure)),
        ("pressure of module 2, cylinder dynamics", error("cylinder_pressure_2", pressure)),
        ("pressure of module 2, modelled air", error("cylinder_pressure_thermal_2", pressure)),
    ]
    lines = [f"{name:<42}{value:8.2f} %" for name, value in rows]
    return "\n".join(["largest error against module 1, of the largest measured value", *lines])
