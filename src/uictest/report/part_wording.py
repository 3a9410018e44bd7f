"""The parts that cases were run with, in words: the name of each part and its changes."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from uictest import evaluation
from uictest.report.escaping import printable

_PATHS = (".yaml", ".yml")


def part_sentence(part: evaluation.EffectivePart, setting: str = "") -> str:
    """Return name, setting and changes: `threshold, changed: slip_threshold 3 km/h (library: 1.146 m/s)`.

    A part whose root is not in the library is marked as an own part, because it may have the name of a
    library part. A section of a scenario has no name; its text is empty if it changes nothing.
    """
    changes = "; ".join(_changes(part, part.key if part.name else ""))
    texts = (part.name, _own_root(part), setting, changes and f"changed: {changes}")
    return printable(", ".join(text for text in texts if text))


def part_sentences(parts: Mapping[str, evaluation.EffectivePart]) -> dict[str, str]:
    """Return the sentence of each part of a case by role; that of the compensation names its setting, too."""
    settings = {"compensation": _setting(parts)} if "compensation" in parts else {}
    sentences = {role: part_sentence(part, settings.get(role, "")) for role, part in parts.items()}
    return {role: sentence for role, sentence in sentences.items() if sentence}


def changed_parameters(
    parts: Mapping[str, evaluation.EffectivePart], varied: Collection[str] = ()
) -> list[str]:
    """Return what differs from the library in a case: `controller.slip_threshold 3 km/h (library: ...)`.

    Values of the scenario itself are compared with its defaults. The keys of `varied` are left out.
    """
    return [printable(change) for part in parts.values() for change in _differences(part, varied)]


def changes_line(result: evaluation.CaseResult) -> list[str]:
    """Return one line with the changed parameters of a case, none where nothing differs."""
    changed = changed_parameters(result.parts)
    return [f"changed parameters: {'; '.join(changed)}"] if changed else []


def base_word(part: evaluation.EffectivePart) -> str:
    """Return the name of the values that a part is compared with."""
    if part.based_on is None:
        return "default"
    return part.based_on if part.based_on.endswith(_PATHS) else "library"


def _own_root(part: evaluation.EffectivePart) -> str:
    """Return that a part is the user's own, and its root file if it has one; empty for a library part."""
    if not part.name or base_word(part) == "library":
        return ""
    return f"own part based on {part.based_on}" if part.based_on else "own part"


def _differences(part: evaluation.EffectivePart, varied: Collection[str]) -> Iterator[str]:
    # A profile has no key; every verdict shows its limits.
    if part.key and part.key not in varied and (own := _own_root(part)):
        yield f"{part.key} {part.name} ({own})"
    yield from _changes(part, "", varied)


def _changes(part: evaluation.EffectivePart, above: str, varied: Collection[str] = ()) -> Iterator[str]:
    for parameter in (each for each in part.changed if each.key not in varied):
        key = parameter.key.removeprefix(f"{above}.")
        yield f"{key} {parameter.written} ({base_word(part)}: {parameter.library_written or 'none'})"
    for key in part.removed:
        yield f"{key.removeprefix(f'{above}.')} removed"


def _setting(parts: Mapping[str, evaluation.EffectivePart]) -> str:
    settings = {each.key: each.written for each in parts["scenario.rig"].parameters}
    if settings["rig.topology"] == "four-caliper":
        return "not in use with four calipers"
    return f"setting {settings['rig.compensation']}"
