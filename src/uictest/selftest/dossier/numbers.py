"""Every number of the library with unit, mark, source and range; the limits of all criteria."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any, Final

from uictest.plans import library, scenario
from uictest.plans.scenario import yaml
from uictest.report import counted
from uictest.rig import bench
from uictest.selftest.dossier.sheet import Section, entries, sheet

_FOLDERS: Final = sorted({*library.FOLDERS, "benches"})
"""Those whose parts have numbers."""


def library_numbers() -> list[dict[str, Any]]:
    """Return every number of every part: part, key, value with unit, mark, source, range and its source."""
    return [entry for part in _parts() for entry in _entries_of(*part)]


def limits() -> list[dict[str, Any]]:
    """Return every bound of every shipped criterion, with clause, mark, source and whether it is verified."""
    profiles = [scenario.load_part(f"criteria/{name}") for name in library.names("criteria")]
    return [
        entry
        for profile in profiles
        if isinstance(profile, scenario.Criteria)
        for criterion in profile.criteria
        for entry in _bounds_of(profile, criterion)
    ]


def numbers_page(numbers: Sequence[dict[str, Any]], bounds: Sequence[dict[str, Any]]) -> str:
    """Return the page: counts by mark, the limits, then the numbers of each part."""
    marks = Counter(each["mark"] for each in numbers)
    ranged = sum(each["range"] is not None for each in numbers)
    counts = ", ".join(f"{count} {mark}" for mark, count in marks.most_common())
    second_hand = sum(each["mark"] != "chosen" for each in bounds)
    said = [
        f"{counted(len(numbers), 'number')} of the library: {counts}; {ranged} have a plausible range.",
        (
            f"{counted(len(bounds), 'limit')} of criteria: {second_hand} quoted from a leaflet second-hand, "
            f"{len(bounds) - second_hand} ours; none is verified, as no leaflet was read."
        ),
    ]
    parts: dict[str, list[dict[str, Any]]] = {}
    for each in numbers:
        parts.setdefault(each["part"], []).append(each)
    rows = [
        {"part": part, "count": len(own), **Counter(each["mark"] for each in own)}
        for part, own in parts.items()
    ]
    headings = {"part": "part", "count": "numbers", **{mark: mark for mark, _ in marks.most_common()}}
    return sheet(
        "Numbers and limits",
        [
            Section("Limits of all criteria", entries(bounds, _LIMITS, wide=("source", "title")), "limits"),
            Section("All parts", entries(rows, headings)),
            *(_section(part, own) for part, own in parts.items()),
        ],
        said=said,
    )


_LIMITS: Final = {
    "profile": "profile",
    "criterion": "criterion",
    "layer": "layer",
    "measure": "measure",
    "limit": "limit",
    "clause": "clause",
    "mark": "mark",
    "verified": "verified",
    "source": "source",
}
_NUMBERS: Final = {
    "key": "number",
    "value": "value",
    "mark": "mark",
    "range": "range",
    "source": "source",
    "range_source": "source of the range",
}


def _section(name: str, numbers: Sequence[dict[str, Any]]) -> Section:
    return Section(name, entries(numbers, _NUMBERS, wide=("source", "range_source")), name.replace("/", "-"))


def _parts() -> Iterator[tuple[str, yaml.Part]]:
    for folder in _FOLDERS:
        for name in library.names(folder):
            if folder == "benches":
                yield f"{folder}/{name}", bench.load_bench(bench.recipe_path(name)).recipe
            else:
                yield f"{folder}/{name}", scenario.load_part(f"{folder}/{name}")


def _entries_of(name: str, part: yaml.Part) -> Iterator[dict[str, Any]]:
    for number in scenario.numbers(part):
        quantity, ends = number.quantity, number.quantity.range
        yield {
            "part": name,
            "key": number.key,
            "value": quantity.text,
            "mark": scenario.mark_of(quantity, part.sources),
            "source": _source(part, quantity),
            "range": ends and f"{ends[0].text} .. {ends[1].text}",
            "range_source": ends and _source(part, ends[0]),
        }


def _source(part: yaml.Part, quantity: yaml.Quantity) -> str | None:
    source = part.sources.get(quantity.source)
    return None if source is None else source.text


def _bounds_of(profile: scenario.Criteria, criterion: scenario.Criterion) -> Iterator[dict[str, Any]]:
    for name, bound in (("lower", criterion.lower), ("upper", criterion.upper)):
        if bound is None:
            continue
        sign = {"lower": ">", "upper": "<"}[name] + ("" if criterion.strict else "=")
        mark = scenario.mark_of(bound, profile.sources)
        yield {
            "profile": profile.name,
            "criterion": criterion.id,
            "title": criterion.title,
            "layer": criterion.layer,
            "measure": criterion.measure,
            "limit": f"{sign} {bound.text}",
            "clause": criterion.clause,
            "mark": mark,
            "verified": "ours, no leaflet's" if mark == "chosen" else "no: read second-hand",
            "source": _source(profile, bound),
        }
