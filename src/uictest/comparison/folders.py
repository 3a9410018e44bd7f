"""Two run folders: their results, and the recordings that both hold."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from pathlib import Path

from uictest.comparison.difference import Comparison
from uictest.comparison.overlay import Overlay, overlay_of
from uictest.comparison.runs import compare_runs
from uictest.comparison.tolerance import Tolerances

DRAWN = 12
"""Stops drawn at most, those that differ first."""

_CHANNELS = ("slide_1", "slide_2", "slide_3", "slide_4", "clamping_force_1", "tank_pressure_1")


def compare_run_folders(first: Path, second: Path, tolerances: Tolerances) -> Comparison:
    """Compare two finished runs. Raises OSError or ValueError where one cannot be read."""
    from uictest.report import read_run

    compared = compare_runs(read_run(first), read_run(second), tolerances)
    return dataclasses.replace(compared, overlays=list(_overlays(compared, first, second)))


def _overlays(compared: Comparison, first: Path, second: Path) -> Iterator[Overlay]:
    from uictest.recording import read_parquet
    from uictest.report.run_report import RECORDINGS

    names = (compared.first, compared.second)
    for case_id in list(dict.fromkeys(difference.case for difference in compared.differences))[:DRAWN]:
        paths = [folder / RECORDINGS / f"{case_id}.parquet" for folder in (first, second)]
        if all(path.is_file() for path in paths):
            recordings = [read_parquet(path) for path in paths]
            yield overlay_of(case_id, recordings[0], recordings[1], names, _CHANNELS)
