"""K_dry as a YAML file, for the tools that compute braking curves."""

from __future__ import annotations

from typing import Any, Final

from uictest.core import document
from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.tail_tables import probability_text, refusal_text, share_text, sliding_words
from uictest.report.sweep.tails import KDry, KDryLevel

K_DRY_FILE: Final = "k_dry.yaml"


def k_dry_yaml(result: SweepResult) -> str:
    """Return K_dry of a sweep as YAML, all digits kept; levels that the sample does not support are null."""
    import yaml  # heavier than all that other sweeps write

    content = {
        **document.head(document.RESULT, "k-dry"),
        "sweep": result.name,
        "tables": list(map(_table, result.k_dry)),
    }
    text: str = yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=110)
    return text


def _table(table: KDry) -> dict[str, Any]:
    return {
        "at": {key: value.text for key, value in table.circumstances.items()},
        "measure": table.measure,
        "nominal_mps2": table.nominal,
        "nominal_from": "sweep file" if table.nominal_is_stated else "nominal case",
        "confidence": share_text(table.confidence),
        "draws": table.sample.draws,
        "draws_without_value": table.sample.without_value,
        "draws_sliding": table.sliding,
        **({"note": sliding_words(table)} if table.sliding else {}),
        "levels": [_level_entry(table, each) for each in table.levels],
    }


def _level_entry(table: KDry, level: KDryLevel) -> dict[str, Any]:
    form = {
        "ebcl": level.ebcl,
        "probability": probability_text(level),
        "draws_needed": level.draws_needed,
        "deceleration_mps2": level.deceleration,
        "k_dry": level.k_dry,
    }
    if level.deceleration is None:
        form["note"] = refusal_text(level.draws_needed, table.sample)
    return form
