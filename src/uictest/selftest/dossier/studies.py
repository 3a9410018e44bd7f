"""The results of the studies, kept with the package: only a checkout has the studies themselves."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from uictest.core.document import Column, Table, Tone
from uictest.selftest.dossier.sheet import Section, entries, sheet

RESULTS: Final = Path(__file__).parent / "studies.json"
_ORDER: Final = ("misses", "holds", "shown", "not run")
_TONES: Final[Mapping[str, Tone]] = {"misses": "odd", "holds": "good"}


def studies() -> dict[str, Any]:
    """Return every study of the catalogue with its quantities, or with the reason why it was not run."""
    kept: dict[str, Any] = json.loads(RESULTS.read_text("utf-8"))
    return kept


def studies_page(kept: Mapping[str, Any]) -> str:
    """Return the page of all studies, those that miss a band first."""
    ordered = sorted(kept["studies"], key=lambda each: _ORDER.index(each["result"]))
    rows = [
        {
            **each,
            "missed": sum(quantity["result"] == "misses" for quantity in each["quantities"]),
            "count": len(each["quantities"]),
        }
        for each in ordered
    ]
    headings = {
        "name": "study",
        "title": "title",
        "result": "result",
        "count": "quantities",
        "missed": "missed",
    }
    whole = Section("All studies", entries(rows, headings, wide=("title",)))
    return sheet("Results of the studies", [whole, *map(_section, ordered)])


def _section(study: Mapping[str, Any]) -> Section:
    asked = [f"{study['title']}.", *([f"Text of the paper: {study['source']}."] if study["source"] else [])]
    if study["result"] == "not run":
        return Section(
            study["name"], None, study["name"], [*asked, f"Not run in this dossier: {study['why']}."]
        )
    ran = f"Result: {study['result']}. Run by uictest {study['version']}."
    return Section(study["name"], quantity_table(study), study["name"], [*asked, ran], study["notes"])


def quantity_table(study: Mapping[str, Any]) -> Table:
    """Return a row for each quantity of a study, what misses its band first."""
    rows = sorted(study["quantities"], key=lambda row: _ORDER.index(row["result"]))
    return Table(
        [
            Column(heading="quantity", text=lambda row: row["title"], wraps=True),
            Column(heading="source says", text=lambda row: row["source"]),
            Column(heading="found", text=lambda row: _number(row["value"], row["unit"])),
            Column(heading="range", text=_range),
            Column(heading="band", text=_band),
            Column(heading="status", text=lambda row: row["status"]),
            Column(
                heading="result", text=lambda row: row["result"], tone=lambda row: _TONES.get(row["result"])
            ),
            Column(heading="declared, because", text=lambda row: row["declared_miss"], wraps=True),
        ],
        rows,
    )


def _range(row: Mapping[str, Any]) -> str:
    """Return the least and the greatest of repeats."""
    return "" if row["low"] is None else f"{row['low']:.4g} .. {row['high']:.4g}"


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
