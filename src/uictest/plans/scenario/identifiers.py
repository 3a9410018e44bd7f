"""Case ids: the scenario's name and the settings of the case, in characters safe for file names."""

import re
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import PurePosixPath
from types import MappingProxyType
from typing import Any, Final

from uictest.plans.scenario.expansion import Setting, Variant
from uictest.plans.scenario.program_files import PROGRAM_FILES
from uictest.plans.scenario.references import Parts, is_path
from uictest.plans.scenario.resolution import PART_KEYS
from uictest.plans.scenario.yaml import (
    Map,
    Node,
    Scalar,
    ScenarioErrors,
    Sequence,
    as_written,
    quoted,
    single_error,
)

LONGEST: Final = 200
"""Longest id: with an extension it must still be a file name everywhere."""

FAULTS: Final = "faults"
"""Key of the faults of a scenario."""

CONTROLLER: Final = "controller"
"""Key of the controller of a scenario."""

EXPECT: Final = "expect"
"""Key of what is expected of a case, which is no part of its id."""

CAR: Final = "car"
"""What tells the cases of the cars of a train apart."""

Labels = Mapping[int, str]
"""What ids call controllers, by the identity of their nodes."""
NO_LABELS: Final[Labels] = MappingProxyType({})
_DIGITS: Final = 8
"""Of a SHA-256 that tells two programs apart."""

_ENTRY = re.compile(r"train\.\d+\.")
_UNSAFE = re.compile(r"[^A-Za-z0-9.+_-]")


def case_id(
    name: str, variant: Variant, short: dict[str, str], labels: Labels = NO_LABELS, car: int = 0
) -> str:
    """``name`` or ``name[friction=0.10,command=90]``; ``short`` maps swept keys to their short names.

    A case that is one car of a train has its number from 1, too.
    """
    texts = [f"{short[setting.key]}={value_label(setting, labels)}" for setting in variant]
    if car:
        texts.append(f"{CAR}={car}")
    return f"{name}[{','.join(texts)}]" if texts else name


def controller_labels(settings: Iterable[Setting], parts: Parts) -> Labels:
    """Return what ids call the controllers among the values of one file.

    That is the name of the part. Several programs of one name are `name@version`, or, where a version is
    unknown or that of another one, `name@` and the first digits of the SHA-256. A controller that cannot be
    resolved has no label: its error is reported where its case is.
    """
    programs: dict[int, tuple[str, str, str]] = {}
    for setting in settings:
        node = setting.value.node
        if setting.key == CONTROLLER and id(node) not in programs:
            with suppress(ScenarioErrors):
                part = parts.part(node, PART_KEYS[CONTROLLER,].model, (CONTROLLER,)).part
                programs[id(node)] = _program_named(part, setting)
    return {key: _told_apart(program, {*programs.values()}) for key, program in programs.items()}


def _program_named(part: Any, setting: Setting) -> tuple[str, str, str]:
    """Return name, version and digits of a controller; one that is built in has a name alone."""
    name = part.name if "name" in part.model_fields_set else _name(setting)
    version, program = getattr(part, "version", None) or "", part.program
    return _safe(name), _safe(version), "" if program is None else program.sha256[:_DIGITS]


def _told_apart(program: tuple[str, str, str], programs: set[tuple[str, str, str]]) -> str:
    name, version, digits = program
    versions = [other_version for other, other_version, _ in programs if other == name]
    if len(versions) == 1:
        return name
    distinct = all(versions) and len(set(versions)) == len(versions)
    return "@".join(filter(None, (name, version if distinct else digits)))


def sets_controller(keys: Iterable[str]) -> bool:
    """Return whether one of some dotted keys is that of a controller, of a car or of all, or below it."""
    return any(CONTROLLER in key.split(".") for key in keys)


def short_keys(keys: list[str]) -> dict[str, str]:
    """The last part of every dotted key, or the shortest tail that is unique.

    That of one entry of `train` begins with the entry: the ids of all cars have it.
    """
    entries = {key: found.group() if (found := _ENTRY.match(key)) else "" for key in keys}
    return {
        key: entry
        + _shortest_tail(
            key.removeprefix(entry),
            [
                other.removeprefix(entry)
                for other, of_other in entries.items()
                if other != key and of_other == entry
            ],
        )
        for key, entry in entries.items()
    }


def _shortest_tail(key: str, others: list[str]) -> str:
    parts = key.split(".")
    for count in range(1, len(parts)):
        tail = ".".join(parts[-count:])
        if not any(other == tail or other.endswith("." + tail) for other in others):
            return tail
    return key


def value_label(setting: Setting, labels: Labels = NO_LABELS) -> str:
    """The value as written in the characters of file names; of a controller, its label."""
    label = labels.get(id(setting.value.node)) or _safe(_name(setting))
    return label or f"value{setting.number}"


def _safe(text: str) -> str:
    return _UNSAFE.sub("", text)


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


def duplicate_id(identifier: str, variant: Variant, first: Variant) -> ScenarioErrors:
    """The error of a second case with the same id: at the value that a list repeats, else at the case."""
    of_first = {setting.key: setting for setting in first}
    pairs = [(setting, of_first[setting.key]) for setting in variant if setting.key in of_first]
    others = [(one, other) for one, other in pairs if one.value.node is not other.value.node]
    setting, twin = others[0]
    message, key = f"a second case {quoted(identifier)}", ""
    if len(others) == 1 and setting.value.key == twin.value.key:  # both stand in the list of one key
        one, other = quoted(as_written(setting.value.node)), quoted(as_written(twin.value.node))
        message = f"{one} appears twice" if one == other else f"{one} and {other} make the same case id"
        key = setting.key
    hint = f"remove one; the first is in line {twin.value.node.place.line}"
    if key == CONTROLLER:
        hint += "; or give each a `name` or a `version` of its own"
    return single_error(setting.value.node.place, message, key, hint)
