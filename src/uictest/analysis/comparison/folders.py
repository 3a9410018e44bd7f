"""Compare two run folders: their results, and the recordings that both contain."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from pathlib import Path

from uictest import report
from uictest.analysis.comparison.channel_difference import allowed_of, channel_difference
from uictest.analysis.comparison.channels import common_channels, in_shown_units, select_channels
from uictest.analysis.comparison.difference import Comparison
from uictest.analysis.comparison.overlay import FIRST_DRAWN, Overlay, default_channels, overlay_of
from uictest.analysis.comparison.runs import compare_runs
from uictest.analysis.comparison.tolerance import Tolerances
from uictest.core import recording
from uictest.report import counted

DRAWN = 12
"""Largest number of stops drawn."""

Pair = tuple["recording.Recording", "recording.Recording"]


def compare_run_folders(first: Path, second: Path, tolerances: Tolerances) -> Comparison:
    """Compare the results of two finished runs. Raises OSError or ValueError where one cannot be read."""
    return compare_runs(report.read_run(first), report.read_run(second), tolerances)


def with_overlays(
    compared: Comparison, first: Path, second: Path, channels: Sequence[str], tolerances: Tolerances
) -> Comparison:
    """Return the comparison of two run folders with the stops that differ drawn over each other.

    Args:
        compared: the results compared.
        first, second: the folders.
        channels: patterns of the channels to draw; a choice of the program where there are none.
        tolerances: a channel that one of them names is drawn with it; the others were given for figures.

    Raises:
        OSError, ValueError: a recording cannot be read, or a pattern matches no channel of any stop.

    """
    cases = list(dict.fromkeys(difference.case for difference in compared.differences))
    pairs = {case_id: pair for case_id in cases[:DRAWN] if (pair := _recordings(case_id, first, second))}
    known = [name for pair in pairs.values() for name in _common(pair)]
    chosen = select_channels(channels, known) if channels and pairs else None
    overlays = [_overlay(case_id, pair, chosen, tolerances) for case_id, pair in pairs.items()]
    remarks = list(_undrawn(cases, pairs, first, second))
    return dataclasses.replace(compared, overlays=overlays, undrawn=remarks)


def _recordings(case_id: str, first: Path, second: Path) -> Pair | None:
    paths = [report.recording_path(folder, case_id) for folder in (first, second)]
    if not all(path.is_file() for path in paths):
        return None
    return in_shown_units(recording.read_parquet(paths[0])), in_shown_units(recording.read_parquet(paths[1]))


def _common(pair: Pair) -> list[str]:
    return common_channels(pair[0].units, pair[1].units)


def _overlay(case_id: str, pair: Pair, chosen: Sequence[str] | None, tolerances: Tolerances) -> Overlay:
    common = _common(pair)
    names = default_channels(FIRST_DRAWN, common) if chosen is None else chosen
    allowed = {name: allowed_of(name, pair[0], tolerances) for name in common if tolerances.names(name)}
    return overlay_of(
        case_id,
        *pair,
        [channel_difference(name, *pair, allowed.get(name)) for name in names if name in common],
    )


def _undrawn(cases: Sequence[str], pairs: dict[str, Pair], first: Path, second: Path) -> Iterator[str]:
    """Yield which stops that differ are not drawn, and why."""
    for case_id in cases[:DRAWN]:
        if case_id not in pairs:
            recorded = [
                each.resolve().name
                for each in (first, second)
                if report.recording_path(each, case_id).is_file()
            ]
            side = f"only {recorded[0]} has" if recorded else "neither run has"
            yield f"{case_id}: {side} a recording; run both with --record all"
    if len(cases) > DRAWN:
        yield f"{counted(len(cases) - DRAWN, 'more stop')} differ and are not drawn: a page draws {DRAWN}"
