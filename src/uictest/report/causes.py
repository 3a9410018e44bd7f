"""Why a stop came out as it did, as far as the program knows: injected faults, a bypassed WSP, no test."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Final

from uictest.judging import evaluation
from uictest.plans.faults import FAULT_KINDS
from uictest.report.escaping import printable

_BYPASSED: Final = "WSP bypassed: the controller did not act, the stop says nothing about it"


def cause_sentences(result: evaluation.CaseResult) -> list[str]:
    """Return what was done to a stop that explains its outcome."""
    bypassed = [_BYPASSED] if is_bypassed(result.parts) else []
    parameters = [each for part in result.parts.values() for each in part.parameters]
    return [*fault_sentences(parameters), *bypassed, *rail_sentences(result)]


def rail_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield why a stop is no test by what its WSP made of it, and what the rail itself is."""
    if (rail := result.rail) is None:
        return
    own = [each for each in result.criteria if each.layer == "validity" and each.status == "fail"]
    of_rail = [_valued(each) for each in rail.criteria if each.value is not None]
    locks = ["wheels lock"] if rail.wheels_lock else []
    decides = ", which decides" if rail.decides else ""
    validity = rail.test_validity.replace("_", " ")
    by_itself = (
        f"does not count as a test by the stop itself: {', '.join(map(_valued, own))}; " if own else ""
    )
    yield printable(
        f"{by_itself}the rail itself (WSP bypassed{decides}) is {validity}: {', '.join([*of_rail, *locks])};"
        f" friction as found {rail.friction}"
    )


def _valued(verdict: evaluation.Verdict) -> str:
    """Return the value of a criterion with its limit: `initial-adhesion 0.0851 g (< 0.08)`."""
    value = "-" if verdict.value is None else f"{verdict.value:.3g} {verdict.unit}"
    limit = verdict.upper if verdict.lower is None else verdict.lower
    sign = "<" if verdict.lower is None else ">"
    return f"{verdict.id} {value}{'' if limit is None else f' ({sign} {limit:g})'}"


def is_bypassed(parts: Mapping[str, evaluation.EffectivePart]) -> bool:
    """Return whether the WSP did not act on the valves in a case with these parts."""
    rig = parts.get("scenario.rig")
    return rig is not None and any(p.key == "rig.wsp" and p.written == "bypassed" for p in rig.parameters)


def fault_sentences(
    parameters: Sequence[evaluation.Parameter], varied: Collection[str] = ()
) -> Iterator[str]:
    """Yield the faults among parameters: `injected fault: vent valve of wheelset 3: stuck closed from 6 s`.

    Of what varies, the keys `varied`, they say nothing.
    """
    faults: dict[str, dict[str, str]] = {}
    for each in parameters:
        above, _, field = each.key.rpartition(".")
        if above.startswith("faults."):
            faults.setdefault(above, {})[field] = "" if each.key in varied else each.written
    for fault in faults.values():
        words = fault_words(*(fault.get(name, "") for name in ("part", "kind", "wheelset", "value")))
        span = [
            f" {word} {fault[key]}" for word, key in (("from", "at"), ("until", "until")) if fault.get(key)
        ]
        yield printable(f"injected fault: {words}{''.join(span)}")


def fault_words(part: str, kind: str, wheelset: str = "", value: str = "") -> str:
    """Return a fault as people say it, e.g. `vent valve of wheelset 3: stuck closed`."""
    of = f" of wheelset {wheelset}" if wheelset else ""
    return f"{part.replace('-', ' ')}{of}: {kind.replace('-', ' ')}{f' {value}' if value else ''}"


def label_words(label: str) -> str:
    """Return the words of the fault that a recording names by its label; of an unknown one the label."""
    for part, kind in FAULT_KINDS:
        if found := re.fullmatch(rf"{part}-{kind}(?:-(\d))?", label):
            return fault_words(part, kind, found[1] or "")
    return label
