"""`uictest library`: list and show the parts of the library, and show those of users."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import runs
from uictest.cli.entry import command
from uictest.cli.options import argument, trusted_folders
from uictest.cli.output import ExitCode, data
from uictest.plans import library as library_files, scenario
from uictest.plans.scenario import yaml
from uictest.recorded import field_data
from uictest.report import aligned_rows, printable
from uictest.rig import bench

library = typer.Typer(rich_markup_mode=None, help="Show the parts that come with the program.")

_FOLDERS = sorted((*library_files.FOLDERS, *library_files.OTHER_FOLDERS))
"""Folders of the library."""


@command(library, "list")
def list_parts() -> ExitCode:
    """List the parts, one per line, each with its title."""
    data(_aligned([(reference, _title(reference)) for reference in _references()]))
    return ExitCode.MET


@command(library, "show")
def show_part(
    reference: Annotated[str, argument("PART", "Part of the library (vehicles/intercity-180), or its file.")],
) -> ExitCode:
    """Show every number of a part with unit, mark (stated, published, identified or chosen) and source.

    And its plausible range, where it states one; for a part that extends another, also the values that
    differ. Below the numbers: the sources, the publications that they cite, and how identified numbers were
    identified. For a channel map: the names that each channel may have in a file.
    """
    if reference.endswith((".yaml", ".yml")):
        _show_file(Path(reference))
        return ExitCode.MET
    if reference not in _references():
        guess = yaml.nearest(reference, _references())
        accepted = f"accepted: {', '.join(f'{folder}/...' for folder in _FOLDERS)}"
        hint = f"did you mean {guess!r}?" if guess else accepted
        raise runs.InvalidInputError(f"no part {reference!r} in the library; {hint}")
    folder, _, name = reference.partition("/")
    data(printable(f"{reference}: {_title(reference)}"))
    if folder == "channel_maps":
        data(_aligned(_channels(name)))
    else:
        _show_numbers(_part(folder, name))
    return ExitCode.MET


def _show_file(path: Path) -> None:
    """Show the file of a part, a bench recipe or a channel map. Raises InvalidInputError for any other."""
    trusted, written = trusted_folders(), yaml.plain(yaml.read_file(path))
    title = written.get("title", "")
    heading = printable(f"{path}: {title}")
    schema = written.get("schema")
    if schema == "uictest/channel-map/1":
        channels = _channels(str(path), trusted)
        data(f"{heading}\n{_aligned(channels)}")
        return
    is_bench = schema == "uictest/bench/1"
    part = _part("benches", str(path), trusted) if is_bench else scenario.load_part_file(path, trusted)
    data(f"{heading}\nbased on {part.based_on}" if part.based_on else heading)
    _show_numbers(part)


def _show_numbers(part: yaml.Part) -> None:
    shown = list(scenario.numbers(part))
    numbers = () if part.original is None else scenario.numbers(part.original)
    original = {number.key: number for number in numbers}
    data(_aligned([(*_row(number), _difference(number, original, part)) for number in shown]))
    if removed := original.keys() - {number.key for number in shown}:
        data(f"removed: {', '.join(sorted(removed))}")
    used = {number.quantity.source for number in shown}
    used |= {end.source for number in shown for end in number.quantity.range or ()}
    sources = [(name, source.text) for name, source in part.sources.items() if name in used]
    cited = [
        (key, publication)
        for key, publication in library_files.references().items()
        if any(text.startswith(f"{key}:") for _, text in sources)
    ]
    provenance = list(getattr(part, "provenance", {}).items())
    for title, rows in (("sources", sources), ("references", cited), ("provenance", provenance)):
        if rows:
            data(f"\n{title}\n{_aligned(rows)}")


def _row(number: scenario.SourcedNumber) -> tuple[str, ...]:
    """Return key, number, mark, name of the source and range; no name if it is the same as the mark."""
    quantity = number.quantity
    if number.source is None:
        return (number.key, quantity.text, scenario.mark_of(quantity, {}), "", "")
    mark, name = number.source.mark, quantity.source
    plausible = ""
    if quantity.range is not None:
        low, high = quantity.range
        source = "" if low.source == quantity.source else f" ({low.source})"
        plausible = f"plausible: {low.text} .. {high.text}, {quantity.prior}{source}"
    return (number.key, quantity.text, mark, "" if name == mark else name, plausible)


def _difference(
    number: scenario.SourcedNumber, original: Mapping[str, scenario.SourcedNumber], part: yaml.Part
) -> str:
    """Return the number in the part that this one extends; empty if it is the same."""
    if part.original is None:
        return ""
    other = original.get(number.key)
    if other is not None and other.quantity == number.quantity:
        return ""
    return f"({part.based_on}: {'none' if other is None else other.quantity.text})"


def _channels(name: str, trusted: Sequence[Path] = ()) -> list[tuple[str, ...]]:
    channels = field_data.load_map(name, trusted)[0].channels.items()
    return [(channel, ", ".join(source.source), source.unit) for channel, source in channels if source]


def _part(folder: str, name: str, trusted: Sequence[Path] = ()) -> yaml.Part:
    if folder == "benches":
        return bench.load_bench(bench.recipe_path(name), trusted=trusted).recipe
    return scenario.load_part(f"{folder}/{name}")


def _title(reference: str) -> str:
    return str(yaml.plain(yaml.read_library(*reference.split("/")))["title"])


def _references() -> list[str]:
    return [f"{folder}/{name}" for folder in _FOLDERS for name in library_files.names(folder)]


def _aligned(rows: Sequence[Sequence[str]]) -> str:
    return "\n".join(aligned_rows([[printable(cell) for cell in row] for row in rows]))
