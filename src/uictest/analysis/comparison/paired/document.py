"""Paired differences as data in JSON."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from typing import Any, Final

from uictest.analysis.comparison.paired.difference import PairedDifference, PairedGroup
from uictest.analysis.comparison.paired.pairing import PairedComparison
from uictest.judging.evaluation import json_form

SCHEMA: Final = "uictest/variants/1"


def paired_form(compared: PairedComparison) -> dict[str, Any]:
    """Return the JSON form; what has no number is null."""
    form: dict[str, Any] = json_form(
        {
            "first": compared.first,
            "second": compared.second,
            "groups": [_group_form(group) for group in compared.groups],
            "not_paired": [dataclasses.asdict(each) for each in compared.not_paired],
        }
    )
    return form


def variants_json(run: str, compared: Sequence[PairedComparison]) -> str:
    """Return the variants of a run as a JSON document."""
    form = {"schema": SCHEMA, "run": run, "variants": [paired_form(each) for each in compared]}
    return json.dumps(form, indent=2, allow_nan=False)


def _group_form(group: PairedGroup) -> dict[str, Any]:
    differences = [_difference_form(each) for each in group.differences]
    return {**dataclasses.asdict(group), "differences": differences}


def _difference_form(difference: PairedDifference) -> dict[str, Any]:
    own = dataclasses.asdict(difference)
    return {**own, "pairs": difference.pairs}
