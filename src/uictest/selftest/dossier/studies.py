"""The results of the studies, kept with the package: only a checkout has the studies themselves."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from uictest.core.document import Column, Table, Tone

RESULTS: Final = Path(__file__).parent / "studies.json"
_ORDER: Final = ("misses", "holds", "shown")
_TONES: Final[Mapping[str, Tone]] = {"misses": "odd", "holds": "good"}


def studies() -> dict[str, Any]:
    """Return the kept document: version that ran them, and each study with its quantities."""
    kept: dict[str, Any] = json.loads(RESULTS.read_text("utf-8"))
    return kept


def study_table(kept: Mapping[str, Any]) -> Table:
    """Return a row for each quantity of each study, what misses its band first."""
    rows = [{**each, "study": study["name"]} for study in kept["studies"] for each in study["quantities"]]
    rows.sort(key=lambda row: _ORDER.index(row["result"]))
    return Table(
        [
            Column(heading="study", text=lambda row: row["study"], literal=True),
            Column(heading="quantity", text=lambda row: row["title"], wraps=True),
            Column(heading="source says", text=lambda row: row["source"]),
            Column(heading="found", text=lambda row: _number(row["value"], row["unit"])),
            Column(heading="band", text=_band),
            Column(heading="status", text=lambda row: row["status"]),
            Column(
                heading="result", text=lambda row: row["result"], tone=lambda row: _TONES.get(row["result"])
            ),
            Column(heading="declared, because", text=lambda row: row["declared_miss"], wraps=True),
        ],
        rows,
        basis=f"Run by uictest {kept['version']}",
    )


def _band(row: Mapping[str, Any]) -> str:
    band = row["band"]
    if not band:
        return ""
    lower, upper = band["lower"], band["upper"]
    below = "<" if band["upper_excluded"] else "<="
    text = (
        f"{below} {upper:g}"
        if lower is None
        else f">= {lower:g}"
        if upper is None
        else f"{lower:g} .. {upper:g}"
    )
    return f"{text} {row['unit']} ({band['of']})".replace("  ", " ")


def _number(value: float | None, unit: str) -> str:
    return "-" if value is None else f"{value:.4g} {unit}".rstrip()
