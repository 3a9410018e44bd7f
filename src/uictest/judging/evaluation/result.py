"""The result of one case: outcome, verdicts, measures in the units a brake engineer reads; its document."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Final

from pydantic import (
    ConfigDict,
    Field,
    PlainSerializer,
    PlainValidator,
    SerializerFunctionWrapHandler,
    TypeAdapter,
    ValidationInfo,
    WrapSerializer,
)

from uictest.controllers import ResponseTimes
from uictest.core import envelope
from uictest.judging.evaluation.car_in_train import CarInTrain
from uictest.judging.evaluation.firmness import WrittenFirmness
from uictest.judging.evaluation.json_values import (
    CaseMeasures,
    CaseWheelsetMeasures,
    Expectation,
    Outcome,
    from_json_form,
    json_form,
    required,
    to_json_form,
)
from uictest.judging.evaluation.parameters import DomainOfValidity, EffectivePart, parts_document, parts_of
from uictest.judging.evaluation.repeats import WrittenRepeats, is_expected
from uictest.judging.evaluation.verdict import (
    Layer,
    Status,
    Verdict,
    WrittenVerdict,
    relative_margin,
    with_outcome_of,
)


def _part_ids(parts: Mapping[str, EffectivePart]) -> dict[str, str]:
    return {role: part.id for role, part in parts.items()}


def _parts_by_role(part_ids: object, info: ValidationInfo) -> dict[str, EffectivePart]:
    """Return the parts that a case names by their ids; the context of the validation holds all by id."""
    if not isinstance(part_ids, Mapping):
        raise ValueError("Input should be a mapping from roles to ids of parts")
    parts: Mapping[str, EffectivePart] = info.context or {}
    if missing := [part_id for part_id in part_ids.values() if part_id not in parts]:
        raise ValueError(f"the document has no part {missing[0]!r}")
    return {role: parts[part_id] for role, part_id in part_ids.items()}


NamedParts = Annotated[
    Mapping[str, EffectivePart], PlainValidator(_parts_by_role), PlainSerializer(_part_ids)
]
"""In JSON a case names its parts by their ids: the document holds each part once."""


@dataclass(frozen=True, slots=True)
class CaseResult:
    """One case, judged. `scenario` is the file as the case names it (forward slashes).

    `reason` says why the outcome is what it is. `measures` is None and `wheelsets` empty when the simulation
    failed. `parts` maps a role (`controller`, ...) to the part that the case was run with. `response_times`
    are those of a controller paced by the clock. `controller_version` is what a controller from outside said
    of itself in this stop, `controller_contract` the version of the contract that it kept (0: none),
    `case_sha256` what named the stop, :func:`uictest.rig.assembly.case_sha256`. `requirements` are the ids of
    those that the case verifies as a whole; its criteria may verify others. `test_case` is its id in a test
    management tool. `noise_key` names the noise of the sensors that a simulated stop met, together with its
    seed, see :mod:`uictest.rig.single_stop`. `domain_of_validity` says whether the case lies where the model
    was validated; None where nobody asked. `strict` says that the case is not met either where one of its
    verdicts is not settled. `firmness` says whether numbers that nobody measured turn its verdicts, where
    that was asked. `train` says where a car ran in its train. The document has these, and `repeats`, only
    where they hold something. `duration` (seconds of wall clock) is for progress and JUnit only, never in the
    document: a result must not depend on the machine.

    A case that repeats its stop has its stops in `repeats`: `measures` and `wheelsets` are then medians over
    them, and `criteria` are verdicts over all of them. `case_sha256` is that of the first.
    """

    id: str
    scenario: str
    parameters: dict[str, str]
    expect: Expectation
    outcome: Outcome
    reason: str = ""
    criteria: tuple[WrittenVerdict, ...] = ()
    measures: CaseMeasures | None = None
    wheelsets: tuple[CaseWheelsetMeasures, ...] = ()
    parts: NamedParts = field(default_factory=dict)
    response_times: ResponseTimes | None = None
    controller_version: str = ""
    controller_contract: int = 0
    case_sha256: str = ""
    requirements: tuple[str, ...] = ()
    test_case: str = ""
    noise_key: str = ""
    repeats: WrittenRepeats | None = None
    domain_of_validity: DomainOfValidity | None = None
    strict: bool = False
    firmness: WrittenFirmness | None = None
    train: CarInTrain | None = None
    duration: Annotated[float, Field(exclude=True)] = field(default=0.0, compare=False)

    @property
    def as_expected(self) -> bool:
        """Whether the outcome is the expected one."""
        return is_expected(self.outcome, self.expect)

    @property
    def unsettled(self) -> tuple[Verdict, ...]:
        """The verdicts for which `strict` does not count the case as met; none without it."""
        return tuple(each for each in self.criteria if self.strict and not each.settled)

    @property
    def met(self) -> bool:
        """Whether the outcome is the expected one and, if `strict`, every verdict settled and it is firm."""
        return self.as_expected and not self.unsettled and not self.lacks_firmness

    @property
    def is_firm(self) -> bool:
        """Whether it was asked how firm the outcome is, and this very outcome is shown to be."""
        own = self.firmness
        return own is not None and (own.nominal, own.status) == (self.outcome, "firm")

    @property
    def lacks_firmness(self) -> bool:
        """Whether, with `strict`, it was asked how firm the outcome is, and it is not shown to be."""
        if self.firmness is None or not self.strict:
            return False
        return not self.is_firm

    @property
    def drawn_stop(self) -> CaseResult:
        """The result of the stop that is recorded and drawn: of a repeated case the first, else this."""
        if self.repeats is None:
            return self
        first = self.repeats.stops[0]
        pairs = ((verdict, first.verdict(verdict.id)) for verdict in self.criteria)
        return replace(
            self,
            outcome=first.outcome,
            reason=first.reason,
            criteria=tuple(with_outcome_of(verdict, own) for verdict, own in pairs if own is not None),
            measures=first.measures,
            wheelsets=first.wheelsets,
            repeats=None,
        )


def outcome_of(verdicts: Iterable[Verdict]) -> tuple[Outcome, str]:
    """Return the outcome of a stop and why."""
    outcome, deciding = deciding_verdicts(verdicts)
    reasons = "; ".join(f"{verdict.id}: {verdict.reason}" for verdict in deciding)
    return outcome, reasons or ("no criterion" if outcome == "skipped" else "")


_JUDGING: Final[tuple[Layer, ...]] = ("validity", "requirement")
"""Layers whose criteria judge a stop."""


def deciding_verdicts(verdicts: Iterable[Verdict]) -> tuple[Outcome, list[Verdict]]:
    """Return the outcome of a stop and the verdicts that decide it, none where it passes.

    A failed check of the rig or a failed validity criterion makes the stop invalid: it does not count as a
    test, whatever its requirements. Checks of the rig decide nothing else. Otherwise a failed requirement
    fails the stop, unless a validity criterion is inconclusive: the stop may be no test. Any other
    inconclusive criterion makes the stop inconclusive. A stop that no criterion of validity or requirement
    could judge is skipped.
    """
    verdicts = list(verdicts)
    failed = [*_with_status(verdicts, ("fail",), "rig"), *_with_status(verdicts, ("fail",), "validity")]
    if failed:
        return "invalid", failed
    verdicts = [verdict for verdict in verdicts if verdict.layer in _JUDGING]
    failed = _with_status(verdicts, ("fail",), "requirement")
    if failed and not _with_status(verdicts, ("inconclusive",), "validity"):
        return "fail", failed
    if _with_status(verdicts, ("inconclusive",)):
        return "inconclusive", _with_status(verdicts, ("fail", "inconclusive"))
    if not _with_status(verdicts, ("pass",)):
        return "skipped", _with_status(verdicts, ("not_applicable",))
    return "pass", []


def _with_status(
    verdicts: Sequence[Verdict], statuses: Sequence[Status], layer: Layer | None = None
) -> list[Verdict]:
    return [verdict for verdict in verdicts if verdict.status in statuses and layer in (None, verdict.layer)]


def narrowest_margin(result: CaseResult) -> tuple[float | None, str]:
    """Return the smallest relative margin of a case and the id of its criterion; None and "" without any.

    Checks of the rig have no part in it.
    """
    margins = [
        (margin, verdict.id)
        for verdict in result.criteria
        if verdict.layer != "rig" and (margin := relative_margin(verdict)) is not None
    ]
    return min(margins, default=(None, ""))


_OF_SOME: Final = (
    *("response_times", "controller_version", "controller_contract", "case_sha256"),
    *("requirements", "test_case", "noise_key", "repeats", "domain_of_validity", "strict", "firmness"),
    "train",
)
"""Fields that the form of a result or a verdict has only where there is something in them."""


def _without_empty(result: CaseResult, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    form = _filled(write(result))
    return {**form, "criteria": [_filled(verdict) for verdict in form["criteria"]]}


def _filled(form: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in form.items() if value or name not in _OF_SOME}


# In code these three default to those of a case that was not simulated.
WrittenCaseResult = Annotated[
    CaseResult, required("criteria", "measures", "wheelsets"), WrapSerializer(_without_empty)
]
"""A result as documents hold it."""

_CASES: Final = TypeAdapter(list[WrittenCaseResult], config=ConfigDict(extra="forbid", defer_build=True))


def result_document(results: Iterable[CaseResult], **header: Any) -> dict[str, Any]:
    """Return the head of results, the header, `parts` and `cases`, with NaN and infinity as None.

    Cases name their parts by ids: a part that many cases share is there once.
    """
    results = list(results)
    return {
        **envelope.head(envelope.RESULT, "run"),
        **json_form(header),
        "parts": parts_document(result.parts for result in results),
        "cases": cases_document(results),
    }


def cases_document(results: Iterable[CaseResult]) -> list[dict[str, Any]]:
    """Return the JSON form of results, NaN and infinity as None, without how long they took."""
    form: list[dict[str, Any]] = to_json_form(_CASES, list(results))
    return form


def cases_of(content: object, parts: Mapping[str, EffectivePart], place: str = "cases") -> list[CaseResult]:
    """Return the results whose JSON form is `content`; `parts` are those they may name, by id.

    `place` is where the content stands in its document. Raises ValueError where a case lacks or adds a field,
    or names another part.
    """
    return from_json_form(_CASES, content, place=place, context=parts)


def results_of(content: Mapping[str, Any]) -> list[CaseResult]:
    """Return the results in a document.

    Raises:
        ValueError: the document is of another schema or kind, or a case in it lacks or adds a field, or two
            share an id.

    """
    try:
        envelope.require(content, envelope.RESULT, "run")
        results = cases_of(content["cases"], parts_of(content))
        _require_distinct(results)
    except KeyError as error:
        raise ValueError(f"no {error}") from error
    return results


def _require_distinct(results: Iterable[CaseResult]) -> None:
    # Readers look cases up by id: of two, one would be compared and the other never seen.
    counts = Counter(result.id for result in results)
    if repeated := [case_id for case_id, count in counts.items() if count > 1]:
        raise ValueError(f"two cases have the id {repeated[0]!r}")


def to_json(content: Mapping[str, Any]) -> str:
    """Return the document as JSON text: two spaces of indentation, newline at the end.

    Raises:
        ValueError: a value in it is NaN or infinite.

    """
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
