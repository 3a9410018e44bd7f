"""Public sources beside the rig: what each is, what was fitted to it, every number with its difference."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from uictest.selftest.dossier.sheet import Section, entries, sheet

_FILE: Final = Path(__file__).parents[1] / "public_sources.json"
KINDS: Final = {
    "measured": "measurement",
    "tabulated": "design table",
    "computed": "another theory, solved by the authors of uictest",
    "second-hand": "text, read second-hand",
}
"""What a source is, in words."""


def public_sources() -> dict[str, Any]:
    """Return the sources with all their numbers, those that miss most first."""
    read: dict[str, Any] = json.loads(_FILE.read_text("utf-8"))
    return read


def sources_page(read: Mapping[str, Any]) -> str:
    """Return the page of all sources: their table, then the numbers of each."""
    rows = [{**each, "what": KINDS[each["kind"]]} for each in read["sources"]]
    said = (
        f"A number holds within {read['tolerance_percent']:g} % of the source's, chosen, the same for all; a "
        "range if ours lies inside. What is not modelled misses. Bias is the mean and spread the standard "
        "deviation of the differences of the predicted numbers; ranges have neither. Fitted numbers are "
        "those that something was set to meet: they are shown, and count for nothing."
    )
    whole = Section("All sources", entries(rows, _SOURCES))
    return sheet("Public sources", [whole, *map(_section, rows)], said=[said])


_SOURCES: Final = {
    "title": "source",
    "what": "what it is",
    "fitted_numbers": "fitted",
    "predicted_numbers": "predicted",
    "missed": "missed",
    "bias_percent": "bias, %",
    "spread_percent": "spread, %",
    "worst_percent": "worst, %",
    "worst": "worst is",
    "result": "result",
}
_NUMBERS: Final = {
    "quantity": "quantity",
    "source": "source",
    "here": "here",
    "difference_percent": "difference, %",
    "status": "status",
    "result": "result",
}


def _section(source: Mapping[str, Any]) -> Section:
    before = (
        f"{source['what'].capitalize()}: {source['place']}.",
        f"Fitted: {source['fitted']}.",
        f"It shows: {source['shows']}",
        f"It does not show: {source['does_not_show']}",
    )
    numbers = sorted(source["numbers"], key=lambda each: each["result"] != "misses")
    return Section(
        source["title"],
        entries(numbers, _NUMBERS, wide=("quantity",)),
        source["name"],
        [each.replace("`", "") for each in before],
        [each.replace("`", "") for each in source["notes"]],
    )
