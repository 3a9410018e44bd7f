"""What results report of a stop and of its wheelsets, and how a stop comes out."""

from __future__ import annotations

import math
import sys
from collections.abc import Collection, Mapping
from functools import partial
from typing import Annotated, Literal

from pydantic import PlainSerializer, PlainValidator

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.judging.evaluation.json_values import json_form

Outcome = Literal["pass", "fail", "invalid", "inconclusive", "error", "skipped"]
Expectation = Literal["pass", "fail", "invalid", "skipped"]


def _columns(content: object, known: Collection[str]) -> dict[str, float]:
    """Return the numbers of a document in these columns; null and what an earlier version lacked as NaN."""
    if not isinstance(content, Mapping) or not content or not set(content) <= set(known):
        raise ValueError(f"Input should have columns out of {', '.join(known)}")
    if not all(value is None or _is_number(value) for value in content.values()):
        raise ValueError("Input should hold numbers only")
    return {name: math.nan if (value := content.get(name)) is None else value for name in known}


def _is_number(value: object) -> bool:
    # JSON writes whole numbers of any length; one beyond the largest float is no measure.
    return type(value) is float or (type(value) is int and abs(value) <= sys.float_info.max)


_finite = PlainSerializer(json_form)
CaseMeasures = Annotated[Mapping[str, float], PlainValidator(partial(_columns, known=STOP_COLUMNS)), _finite]
"""What a result reports of a stop: a key of :data:`.STOP_COLUMNS` -> number, NaN: not reached."""

CaseWheelsetMeasures = Annotated[
    Mapping[str, float], PlainValidator(partial(_columns, known=WHEELSET_COLUMNS)), _finite
]
"""What it reports of one wheelset: a key of :data:`.WHEELSET_COLUMNS` -> number, NaN: not reached."""
