"""The library: parts that ship with the program, as data files with the source of every number."""

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


__all__ = ["FOLDERS", "OTHER_FOLDERS", "content", "names", "references", "table"]
