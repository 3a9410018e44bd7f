"""Data as text inside a page: JSON, and lines with a byte or two per sample, deflated."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.report.traces.trace import Curve

STEPS = 32766
"""Into so many steps the range of a line is divided."""

_MISSING = 32767

Series = NDArray[np.float64]
Scale = tuple[float, float]
"""Offset and step: value = offset + step x number."""


def script_json(content: Any) -> str:
    """Return JSON that can stand inside a script element, whatever texts it holds."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def packed(curves: Mapping[str, Curve], interval: float = 0.0) -> dict[str, Any]:
    """Return lines as `{"lines": {name: {"count", "x", "y"}}, "data"}`; `x` and `y` are `[offset, step]`.

    A value is offset + step x number, 32767 in y for missing. `data` holds the numbers of every line, x
    before y, each as the difference from the number before it: signed, two bytes, all low bytes before all
    high ones, deflated, base64. What is lost of a value is at most half a step, a sixty-thousandth of the
    range; of an x that is a multiple of `interval`, nothing.
    """
    lines, parts = {}, []
    for name, curve in curves.items():
        across, up = _scale_of_times(curve.x, interval), _scale(curve.y)
        lines[name] = {"count": len(curve.x), "x": across, "y": up}
        parts += [_differences(_numbers(curve.x, across)), _differences(_numbers(curve.y, up))]
    numbers = np.concatenate(parts).astype("<i2") if parts else np.zeros(0, "<i2")
    data = zlib.compress(numbers.view(np.uint8).reshape(-1, 2).T.tobytes(), 9)
    return {"lines": lines, "data": base64.b64encode(data).decode("ascii")}


def _scale(series: Series) -> Scale:
    finite = series[np.isfinite(series)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    return low, (high - low) / STEPS or 1.0


def _scale_of_times(times: Series, interval: float) -> Scale:
    """Return the interval of the record as the step of its times, where two bytes hold the differences."""
    if interval > 0.0 and np.diff(times, prepend=times[:1]).max(initial=0.0) < STEPS * interval:
        return float(times[0]), interval
    return _scale(times)


def _numbers(series: Series, scale: Scale) -> NDArray[np.int64]:
    offset, step = scale
    known = np.isfinite(series)
    return np.where(known, np.rint((np.where(known, series, offset) - offset) / step), _MISSING).astype(
        np.int64
    )


def _differences(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.diff(numbers, prepend=np.int64(0))
