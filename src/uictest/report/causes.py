"""Why a stop came out as it did, as far as the program knows: injected faults, a bypassed WSP, no test."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Final

from uictest.judging import evaluation
from uictest.plans.faults import FAULT_KINDS
from uictest.report.escaping import printable

_ABOVE: Final = {"initial_adhesion": "the rail is too good (initial adhesion too high)"}
_BELOW: Final = {
    "sliding_share": "too few wheelsets slide, or not for long enough",
    "sliding_share_of_wheelsets": "the wheelsets do not slide for long enough",
    "maximum_slide_above_cutoff": "the wheelsets do not slide deep enough",
    "standstill": "the train does not come to a standstill",
}
"""What it means that a value is above, or below, its bounds, where that says more than `too high`."""
_BYPASSED: Final = "WSP bypassed: the controller did not act, the stop says nothing about it"


def cause_sentences(result: evaluation.CaseResult) -> list[str]:
    """Return what was done to a stop that explains its outcome, and why an invalid one is no test."""
    bypassed = [_BYPASSED] if is_bypassed(result.parts) else []
    parameters = [each for part in result.parts.values() for each in part.parameters]
    return [*fault_sentences(parameters), *bypassed, *_why_no_test(result)]


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


def _why_no_test(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield why a stop does not count as a test; nothing where it does."""
    outcome, deciding = evaluation.deciding_verdicts(result.criteria)
    if result.outcome != "invalid" or outcome != "invalid":
        return
    reasons = [_out_of_bounds(each) for each in deciding if each.layer == "validity"]
    if wrong := [each.id for each in deciding if each.layer == "rig"]:
        reasons.insert(0, f"a check of the rig fails ({', '.join(wrong)})")
    yield printable(f"no test: {'; '.join(reasons)}")


def _out_of_bounds(verdict: evaluation.Verdict) -> str:
    name = verdict.measure.replace("_", " ") or verdict.id
    if verdict.value is None or verdict.over_stops is not None:
        return f"{name} out of its limits"
    if verdict.upper is not None and verdict.value >= verdict.upper:
        return _ABOVE.get(verdict.measure, f"{name} too high")
    return _BELOW.get(verdict.measure, f"{name} too low")


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
