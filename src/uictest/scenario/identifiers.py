"""Case ids: the scenario's name and the settings of the case, in characters safe for file names."""

import re
from pathlib import PurePosixPath
from typing import Final

from uictest.scenario.expansion import Setting, Variant
from uictest.scenario.parts.external_controller import PROGRAM_FILES
from uictest.scenario.references import is_path
from uictest.scenario.yaml import Map, Node, Scalar, Sequence

LONGEST: Final = 200
"""Longest id: with an extension it must still be a file name everywhere."""

FAULTS: Final = "faults"
"""Key of the faults of a scenario."""

_UNSAFE = re.compile(r"[^A-Za-z0-9.+_-]")


def case_id(name: str, variant: Variant, short: dict[str, str]) -> str:
    """``name`` or ``name[friction=0.10,command=90]``; ``short`` maps swept keys to their short names."""
    if not variant:
        return name
    return f"{name}[{','.join(f'{short[setting.key]}={value_label(setting)}' for setting in variant)}]"


def short_keys(keys: list[str]) -> dict[str, str]:
    """The last part of every dotted key, or the shortest tail that is unique."""
    return {key: _shortest_tail(key, [other for other in keys if other != key]) for key in keys}


def _shortest_tail(key: str, others: list[str]) -> str:
    parts = key.split(".")
    for count in range(1, len(parts)):
        tail = ".".join(parts[-count:])
        if not any(other == tail or other.endswith("." + tail) for other in others):
            return tail
    return key


def value_label(setting: Setting) -> str:
    """The value as written, without the characters that a file name must not contain."""
    text = _name(setting)
    return _UNSAFE.sub("", text) or f"value{setting.number}"


def _name(setting: Setting) -> str:
    node = setting.value.node
    if setting.key == FAULTS and isinstance(node, Sequence):
        return "+".join(map(_name_of_fault, node.items)) or "none"
    if isinstance(node, Map):
        program = next((node.get(key) for key in PROGRAM_FILES if key in node.entries), None)
        if isinstance(program, Scalar):
            return PurePosixPath(program.text).stem
        node = node.get("name") or node.get("extends") or node
    if not isinstance(node, Scalar):
        return f"value{setting.number}"
    return PurePosixPath(node.text).stem if is_path(node.text) else node.text


_NAMED_BY: Final = ("part", "kind", "value", "wheelset", "at", "until")


def _name_of_fault(node: Node) -> str:
    """Return what tells a fault from others: `speed-sensor-stuck-2-3s`."""
    named = (node.get(key) for key in _NAMED_BY) if isinstance(node, Map) else ()
    return "-".join(each.text for each in named if isinstance(each, Scalar))
