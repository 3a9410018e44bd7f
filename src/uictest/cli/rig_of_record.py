"""The rig that `uictest identify air` assumes for a record."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path

from uictest import runs
from uictest.plans import scenario
from uictest.rig import bench


def rig_of_record(
    record: Path, stated: Mapping[str, str], overrides: Sequence[str], trusted: Sequence[Path]
) -> scenario.Case:
    """Return the rig of the library with overrides.

    Raises InvalidInputError where the record states another tank or valve (`stated`, by the keys of a
    scenario).
    """
    case = bench.trace_recipe(record, "", None, overrides, None, trusted).case
    assumed = scenario.rig_as_built(case.scenario)
    of_air = [key for key in stated if key in assumed and key.startswith("brake.system.")]
    own = bench.trace_recipe(record, "", None, [f"{key}={stated[key]}" for key in of_air]).case
    values = scenario.rig_as_built(own.scenario)
    other = [key for key in of_air if values[key] != assumed[key]]
    if other:
        listed = "; ".join(f"{key} {values[key].text}, not {assumed[key].text}" for key in other)
        options = " ".join(f"--set {shlex.quote(f'{key}={values[key].text}')}" for key in other)
        raise runs.InvalidInputError(
            f"{record}: recorded on another rig than assumed: {listed}; write {options}"
        )
    return case
