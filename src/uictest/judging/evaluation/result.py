"""The result of a case: where its car ran, verdicts, measures and outcome; its document."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
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
from uictest.core.units import with_unit
from uictest.judging.evaluation.effective_parts import EffectivePart, parts_document, parts_of
from uictest.judging.evaluation.firmness import WrittenFirmness
from uictest.judging.evaluation.json_values import (
    CaseMeasures,
    CaseWheelsetMeasures,
    Outcome,
    absent_if_empty,
    from_json_form,
    ignored,
    json_form,
    required,
    to_json_form,
)
from uictest.judging.evaluation.outcome import (
    RequirementStatus,
    TestValidity,
    WrittenRailValidity,
    decided_by,
    is_expected,
    requirements_of,
    validity_of,
)
from uictest.judging.evaluation.repeats import WrittenRepeats
from uictest.judging.evaluation.verdict import Verdict, WrittenVerdict, relative_margin, with_outcome_of
from uictest.plans import scenario
from uictest.plans.scenario import WrittenExpectation

WrittenCarFigures = Annotated[scenario.CarFigures, absent_if_empty("implausible")]
"""In JSON the figures of a car list what is implausible only where something is."""

_KILONEWTON = 1e3


@dataclass(frozen=True, slots=True)
class CouplerForces:
    """The largest forces in a coupler during a stop, N; neither is negative."""

    largest_pull_n: float
    largest_push_n: float

    def __str__(self) -> str:
        pull, push = (f"{each / _KILONEWTON:.1f}" for each in (self.largest_pull_n, self.largest_push_n))
        return f"pull {with_unit(pull, 'kN')}, push {with_unit(push, 'kN')}"


@dataclass(frozen=True, slots=True)
class CarInTrain:
    """The place of a car in its train; over several stops of a case the largest forces of all.

    Args:
        train: id of the train.
        car: its number, from 1 for the leading one.
        cars: cars of the train.
        ahead: forces in the coupler to the car ahead; None for the leading car, and where no stop ended.
        behind: forces in the coupler to the car behind; None for the last car, and where no stop ended.

    """

    train: str
    car: int
    cars: int
    ahead: CouplerForces | None = None
    behind: CouplerForces | None = None

    @property
    def label(self) -> str:
        """The place in words: `car 2 of 4`."""
        return f"car {self.car} of {self.cars}"

    @property
    def couplers(self) -> Iterator[tuple[str, CouplerForces]]:
        """The couplers that it has, `ahead` and `behind`, with their forces."""
        for name, forces in (("ahead", self.ahead), ("behind", self.behind)):
            if forces is not None:
                yield name, forces


def place_in_train(case: scenario.Case) -> CarInTrain | None:
    """Return where the car of a case runs, None for one that runs alone."""
    place = case.train
    return None if place is None else CarInTrain(place.train, place.number, len(place.scenarios))


def over_stops_of_train(places: Sequence[CarInTrain | None]) -> CarInTrain | None:
    """Return the place of a car over several stops of its train, with the largest forces of all."""
    known = [each for each in places if each is not None]
    if not known:
        return None
    return replace(
        known[0],
        ahead=_largest_forces(each.ahead for each in known),
        behind=_largest_forces(each.behind for each in known),
    )


def _largest_forces(forces: Iterable[CouplerForces | None]) -> CouplerForces | None:
    ends = [(each.largest_pull_n, each.largest_push_n) for each in forces if each is not None]
    return CouplerForces(*map(max, zip(*ends, strict=True))) if ends else None


Found = str | tuple[float, float] | None
"""A setting or the name of a part; the lowest and the highest value of a number, SI; None: it is not set."""


@dataclass(frozen=True, slots=True)
class Deviation:
    """One condition of a case that none of the validated stops had.

    Args:
        key: key of the scenario, or of a part.
        found: in the case.
        validated: among the validated stops that come nearest to it.
        unit: unit of numbers, SI.

    """

    key: str
    found: Found
    validated: Found
    unit: str = ""


@dataclass(frozen=True, slots=True)
class DomainOfValidity:
    """Whether a case lies in the domain of a validation: then nothing is `outside`.

    Args:
        validation: its name.
        sha256: SHA-256 of its file.
        outside: every condition beyond it.

    """

    validation: str
    sha256: str
    outside: tuple[Deviation, ...] = ()


def _parts_by_role(part_ids: object, info: ValidationInfo) -> dict[str, EffectivePart]:
    """Return the parts that a case names by their ids; the context of the validation holds all by id."""
    if not isinstance(part_ids, Mapping):
        raise ValueError("Input should be a mapping from roles to ids of parts")
    parts: Mapping[str, EffectivePart] = info.context or {}
    if missing := [part_id for part_id in part_ids.values() if part_id not in parts]:
        raise ValueError(f"the document has no part {missing[0]!r}")
    return {role: parts[part_id] for role, part_id in part_ids.items()}


NamedParts = Annotated[
    Mapping[str, EffectivePart],
    PlainValidator(_parts_by_role),
    PlainSerializer(lambda parts: {role: part.id for role, part in parts.items()}),
]
"""In JSON a case names its parts by their ids: the document holds each part once."""


@dataclass(frozen=True)
class CaseResult:
    """One case, judged. `scenario` is the file as the case names it (forward slashes).

    `reason` says why the outcome is what it is. `measures` is None and `wheelsets` empty when the simulation
    failed. `parts` maps a role (`controller`, ...) to the part that the case was run with. `response_times`
    are those of a controller paced by the clock. `controller_version` is what a controller from outside said
    of itself in this stop, `controller_contract` the version of the contract that it kept (0: none),
    `case_sha256` what named the stop, :func:`uictest.rig.assembly.case_sha256`. `requirements` are the ids of
    those that the case verifies as a whole; its criteria may verify others. `test_case` is its id in a test
    management tool. `noise_key` names the noise of the sensors that a simulated stop met, together with its
    seed, see :mod:`uictest.rig.train_stop`. `domain_of_validity` says whether the case lies where the model
    was validated; None where nobody asked. `strict` says that the case is not met either where one of its
    verdicts is not settled. `firmness` says whether unmeasured numbers turn its verdicts, where that was
    asked. `train` says where a car ran in its train, `car` its mass and what follows, `rail` whether the rail
    itself makes the stop a test, where the stop with the WSP active is none, `controller_log` the file below
    the run with what the controller printed. The document has these, and `repeats`, only where they hold
    something, never `duration`, seconds for progress and JUnit.

    A case that repeats its stop has its stops in `repeats`: `measures` and `wheelsets` are then medians over
    them, and `criteria` are verdicts over all of them. `case_sha256` is that of the first.
    """

    id: str
    scenario: str
    parameters: dict[str, str]
    expect: WrittenExpectation
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
    rail: WrittenRailValidity | None = None
    car: WrittenCarFigures | None = None
    controller_log: str = ""
    duration: Annotated[float, Field(exclude=True)] = field(default=0.0, compare=False)

    @cached_property
    def as_expected(self) -> bool:
        """Whether it came out as expected; of a repeated case, as many of its stops as its rule asks for."""
        if self.repeats is not None and self.repeats.needed is not None:
            return self.outcome != "error" and self.repeats.as_expected(self.expect) >= self.repeats.needed
        return is_expected(self.outcome, self.decided, self.expect)

    @property
    def decided(self) -> tuple[Verdict, ...]:
        """The verdicts that decide the outcome, see :func:`decided_by`."""
        return decided_by(self.criteria, self.rail)

    @property
    def test_validity(self) -> TestValidity:
        """Whether the stop is a test as measured, also where the rail decides; over all stops of a case."""
        return validity_of(self.criteria)

    @property
    def requirement_status(self) -> RequirementStatus:
        """Whether the requirements are met, over all stops of a repeated case."""
        return requirements_of(self.criteria)

    @property
    def allowed(self) -> tuple[Verdict, ...]:
        """What is missed and was allowed: by name, for another controller than that of the case.

        Of a repeated case whose stops are counted also what only some of them miss.
        """
        expect = self.expect
        if not (expect.is_allowance and self.as_expected) or self.outcome == "pass":
            return ()
        counted = self.repeats.stops if self.repeats is not None and self.repeats.needed is not None else ()
        named = (*expect.fail, *expect.invalid)
        every = [each for own in (self.decided, *(stop.decided for stop in counted)) for each in own]
        missed = [each for each in every if each.status == "fail" and each.id in named]
        return tuple({each.id: each for each in reversed(missed)}.values())[::-1]

    @property
    def unsettled(self) -> tuple[Verdict, ...]:
        """The verdicts for which `strict` does not count the case as met; none without it."""
        return tuple(each for each in self.decided if self.strict and not each.settled)

    @property
    def met(self) -> bool:
        """Whether it came out as expected and, if `strict`, with nothing left open.

        Nothing is where every verdict is settled, the outcome is firm if that was asked, what may be missed
        is named, and nothing is missed that is allowed only.
        """
        is_open = self.strict and (
            self.unsettled or self.lacks_firmness or self.expect.lacks_names or self.allowed
        )
        return self.as_expected and not is_open

    @property
    def is_firm(self) -> bool:
        """Whether it was asked how firm the outcome is, and this very outcome is shown to be."""
        return self.firmness is not None and self.firmness.shows(self.outcome)

    @property
    def lacks_firmness(self) -> bool:
        """Whether, with `strict`, it was asked how firm the outcome is, and it is not shown to be."""
        return self.strict and self.firmness is not None and not self.is_firm

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
            rail=first.rail,
            repeats=None,
        )


def narrowest_margin(
    result: CaseResult, layers: Collection[str] = ("validity", "requirement")
) -> tuple[float | None, str]:
    """Return the smallest relative margin of a case and the id of its criterion; None and "" without any.

    Checks of the rig and of the record have no part in it.
    """
    margins = [
        (margin, verdict.id)
        for verdict in result.criteria
        if verdict.layer in layers and (margin := relative_margin(verdict)) is not None
    ]
    return min(margins, default=(None, ""))


_OF_SOME: Final = (
    *("response_times", "controller_version", "controller_contract", "case_sha256"),
    *("requirements", "test_case", "noise_key", "repeats", "domain_of_validity", "strict", "firmness"),
    *("train", "car", "rail", "controller_log"),
)
"""Fields that the form of a result or a verdict has only where there is something in them."""


_STATEMENTS: Final = ("test_validity", "requirement_status")


def _written_form(result: CaseResult, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    form = _without_empty_fields(write(result))
    statements = {name: getattr(result, name) for name in _STATEMENTS}
    return {
        **form,
        **statements,
        "criteria": [_without_empty_fields(verdict) for verdict in form["criteria"]],
    }


def _without_empty_fields(form: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in form.items() if value or name not in _OF_SOME}


# In code these three default to those of a case that was not simulated.
WrittenCaseResult = Annotated[
    CaseResult,
    required("criteria", "measures", "wheelsets"),
    ignored(*_STATEMENTS),
    WrapSerializer(_written_form),
]
"""A result as documents hold it; what its verdicts come to stands there for readers that need no more."""


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
    names another part, or has other columns of measures than the rest.
    """
    results = from_json_form(_CASES, content, place=place, context=parts)
    _require_same_columns(content, place)
    return results


def _require_same_columns(cases: Any, place: str) -> None:
    # A document of an older program lacks a column in every stop, a damaged one in some.
    stops = [stop for case in cases for stop in (case, *(case.get("repeats") or {}).get("stops", ()))]
    of_stops = {frozenset(stop["measures"]) for stop in stops if stop.get("measures")}
    of_wheelsets = {frozenset(columns) for stop in stops for columns in stop.get("wheelsets", ())}
    if len(of_stops) > 1 or len(of_wheelsets) > 1:
        raise ValueError(f"{place}: all stops should have the same columns of measures")


def results_of(content: Mapping[str, Any]) -> list[CaseResult]:
    """Return the results in a document.

    Raises:
        ValueError: the document is of another schema or kind, or a case in it lacks or adds a field, or two
            share an id.

    """
    try:
        envelope.require(content, envelope.RESULT, "run")
        results = cases_of(content["cases"], parts_of(content))
    except KeyError as error:
        raise ValueError(f"no {error}") from error
    # Readers look cases up by id: of two, one would be compared and the other never seen.
    counts = Counter(result.id for result in results)
    if repeated := [case_id for case_id, count in counts.items() if count > 1]:
        raise ValueError(f"two cases have the id {repeated[0]!r}")
    return results


def to_json(content: Mapping[str, Any]) -> str:
    """Return the document as JSON text: two spaces of indentation, newline at the end.

    Raises:
        ValueError: a value in it is NaN or infinite.

    """
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
