"""Units written into the names of channels, as in `speed [m/s]`."""

from __future__ import annotations

import re

_NAME_AND_UNIT = re.compile(r"\s*(?P<name>.*?)\s*(?:\[(?P<square>[^\[\]]*)\]|\((?P<round>[^()]*)\))\s*")


def name_and_unit(text: str) -> tuple[str, str]:
    """Return the name and the unit in brackets at its end; an empty unit where there is none."""
    match = _NAME_AND_UNIT.fullmatch(text[:500])
    if match is None or not match["name"]:
        return text.strip(), ""
    return match["name"], (match["square"] or match["round"] or "").strip()
