"""What of the trains of cases is implausible, as diagnostics at the keys it follows from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from uictest.plans import library, scenario
from uictest.plans.scenario import yaml


def implausible_trains(cases: Iterable[scenario.Case]) -> list[yaml.Diagnostic]:
    """Return a diagnostic for each derived quantity beyond its span, once for all cases that share it."""
    found = dict.fromkeys(
        (case.path, each) for case in cases for each in scenario.car_figures(case.scenario).implausible
    )
    return [
        yaml.diagnose(place, str(each), key, each.likely)
        for path, each in found
        for place, key in [_place(path, each.keys)]
    ]


def place_of_key(path: Path, key: str) -> yaml.Place | None:
    """Return where a scenario file, or a file that it refers to, sets a key; None where none does."""
    path = library.named_scenario(path)
    node: yaml.Node | None = yaml.read_file(path)
    names = key.split(".")
    for depth, name in enumerate(names):
        inner = node.get(name) if isinstance(node, yaml.Map) else None
        if inner is None:
            reference = node.get("extends") if isinstance(node, yaml.Map) else node
            if not isinstance(reference, yaml.Scalar) or not scenario.is_path(reference.text):
                return None
            return place_of_key(path.parent / reference.text, ".".join(names[depth:]))
        node = inner
    return None if node is None else node.place


def _place(path: Path, keys: Sequence[str]) -> tuple[yaml.Place, str]:
    """Return the first of some keys that is set, and where; without any the first key and the whole file."""
    for key in keys:
        if (place := place_of_key(path, key)) is not None:
            return place, key
    return yaml.whole_file(path), keys[0]
