"""Compare two run folders: their results, and the recordings that both contain."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from pathlib import Path

from uictest import recording, report
from uictest.comparison.channels import common_channels, in_shown_units, select_channels
from uictest.comparison.difference import Comparison
from uictest.comparison.overlay import FIRST_DRAWN, Overlay, default_channels, overlay_of
from uictest.comparison.runs import compare_runs
from uictest.comparison.tolerance import Tolerances
from uictest.report import counted

DRAWN = 12
"""Largest number of stops drawn."""

Pair = tuple["recording.Recording", "recording.Recording"]


def compare_run_folders(first: Path, second: Path, tolerances: Tolerances) -> Comparison:
    """Compare the results of two finished runs. Raises OSError or ValueError where one cannot be read."""
    return compare_runs(report.read_run(first), report.read_run(second), tolerances)


def with_overlays(compared: Comparison, first: Path, second: Path, channels: Sequence[str]) -> Comparison:
    """Return the comparison of two run folders with the stops that differ drawn over each other.

    Args:
        compared: the results compared.
        first, second: the folders.
        channels: patterns of the channels to draw; a choice of the program where there are none.

    Raises:
        OSError, ValueError: a recording cannot be read, or a pattern matches no channel of any stop.

    """
    cases = list(dict.fromkeys(difference.case for difference in compared.differences))
    pairs = {case_id: pair for case_id in cases[:DRAWN] if (pair := _recordings(case_id, first, second))}
    names = (compared.first, compared.second)
    known = [name for pair in pairs.values() for name in _common(pair)]
    chosen = select_channels(channels, known) if channels and pairs else None
    overlays = [_overlay(case_id, pair, names, chosen) for case_id, pair in pairs.items()]
    remarks = list(_undrawn(cases, pairs, first, second))
    return dataclasses.replace(compared, overlays=overlays, undrawn=remarks)


def _recordings(case_id: str, first: Path, second: Path) -> Pair | None:
    paths = [_place(folder, case_id) for folder in (first, second)]
    if not all(path.is_file() for path in paths):
        return None
    return in_shown_units(recording.read_parquet(paths[0])), in_shown_units(recording.read_parquet(paths[1]))


def _place(folder: Path, case_id: str) -> Path:
    return folder / report.RECORDINGS / f"{case_id}.parquet"


def _common(pair: Pair) -> list[str]:
    return common_channels(pair[0].units, pair[1].units)


def _overlay(case_id: str, pair: Pair, names: tuple[str, str], chosen: Sequence[str] | None) -> Overlay:
    common = _common(pair)
    if chosen is None:
        drawn = default_channels(FIRST_DRAWN, common)
    else:
        drawn = [name for name in chosen if name in common]
    return overlay_of(case_id, *pair, names, drawn)


def _undrawn(cases: Sequence[str], pairs: dict[str, Pair], first: Path, second: Path) -> Iterator[str]:
    """Yield which stops that differ are not drawn, and why."""
    for case_id in cases[:DRAWN]:
        if case_id not in pairs:
            recorded = [each.resolve().name for each in (first, second) if _place(each, case_id).is_file()]
            side = f"only {recorded[0]} has" if recorded else "neither run has"
            yield f"{case_id}: {side} a recording; run both with --record all"
    if len(cases) > DRAWN:
        yield f"{counted(len(cases) - DRAWN, 'more stop')} differ and are not drawn: a page draws {DRAWN}"
