"""The library: parts that ship with the program, as data files with the source of every number."""

import os
from functools import cache
from pathlib import Path
from typing import Final

# Plain paths: importing importlib.resources would take longer than reading the files does.
_HERE: Final = Path(__file__).parent

FOLDERS: Final = {
    "brakes": "brake",
    "calipers": "caliper",
    "compensations": "compensation",
    "controllers": "controller",
    "criteria": "criteria",
    "measures": "measures",
    "pads": "pad",
    "rails": "rail",
    "sensors": "sensors",
    "vehicles": "vehicle",
}
"""The folders of the library with parts of a scenario -> the kind of part in each."""

_OF_WHEEL, _OF_CLONE = _HERE / "scenarios", _HERE.parents[3] / "scenarios"
SCENARIOS: Final = _OF_WHEEL if _OF_WHEEL.is_dir() else _OF_CLONE
"""The folder of the scenarios that ship with the program."""

OTHER_FOLDERS: Final = ("benches", "channel_maps")
"""The folders of files that no scenario refers to: bench recipes and channel maps."""


@cache
def names(folder: str) -> tuple[str, ...]:
    """Names of the parts in a folder of the library, sorted."""
    return tuple(sorted(path.stem for path in (_HERE / folder).glob("*.yaml")))


def content(folder: str, name: str) -> bytes:
    """The bytes of a library file. Raises KeyError when there is no such part."""
    if folder not in (*FOLDERS, *OTHER_FOLDERS) or name not in names(folder):
        raise KeyError(f"{folder}/{name}")
    return (_HERE / folder / f"{name}.yaml").read_bytes()


@cache
def scenarios() -> dict[str, Path]:
    """The scenarios, sweeps and series that ship with the program, by name."""
    return {path.name.partition(".")[0]: path for path in sorted(SCENARIOS.glob("*.yaml"))}


def named_scenario(path: Path) -> Path:
    """The shipped scenario that a path names where it leads to no file: `slip-120`; else the path itself."""
    return path if os.path.lexists(path) else scenarios().get(str(path), path)


def scenario_name(path: Path, working: Path) -> str:
    """The name of a shipped scenario; empty for other files, and below the working folder of a clone.

    `path` and `working` are absolute.
    """
    in_clone = SCENARIOS == _OF_CLONE and path.is_relative_to(working)
    return "" if path.parent != SCENARIOS or in_clone else path.name.partition(".")[0]


@cache
def references() -> dict[str, str]:
    """The publications that the library cites: short form -> full citation.

    The source of every stated or published number begins with a short form, a colon and the place.
    """
    import yaml

    citations: dict[str, str] = yaml.safe_load((_HERE / "references.yaml").read_text("utf-8"))
    return citations


def table(name: str) -> str:
    """Return the text of a table that ships as CSV."""
    return (_HERE / name).read_text("utf-8")


__all__ = [
    "FOLDERS",
    "OTHER_FOLDERS",
    "SCENARIOS",
    "content",
    "named_scenario",
    "names",
    "references",
    "scenario_name",
    "scenarios",
    "table",
]
