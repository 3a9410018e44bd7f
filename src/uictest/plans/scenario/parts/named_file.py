"""Entries of a file of stops besides the stops: name, requirements, repeats, expected outcome."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Final, Literal, get_args

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    PlainSerializer,
    PlainValidator,
    Tag,
    WithJsonSchema,
)

from uictest.plans.scenario.yaml import (
    NAME_PATTERN,
    Document,
    Inconsistency,
    List,
    Location,
    Map,
    Model,
    Quantity,
    Scalar,
    describe,
    diagnose,
    field,
    optional,
    parse,
    quantity,
    quoted,
    read_document,
    refused,
    require_none,
    single_error,
    suggestion,
)

REQUIREMENT_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9._:/-]{0,99}$"
"""No blank, comma or semicolon: those separate ids in lists."""
RequirementId = Annotated[str, Field(pattern=REQUIREMENT_PATTERN)]
RequirementIds = Annotated[tuple[RequirementId, ...], Field(max_length=100)]


def repeated_requirements(requirements: Sequence[str]) -> Iterator[Inconsistency]:
    """Yield every id that a list under the key `requirements` names a second time."""
    for index, requirement in enumerate(requirements):
        if requirement in requirements[:index]:
            yield Inconsistency(("requirements", index), f"{quoted(requirement)} appears twice", "remove one")


Slug = Annotated[str, Field(pattern=NAME_PATTERN)]


class NamedFile(Model):
    """A file with a name; each kind narrows `schema_id` to what it is called."""

    schema_id: str = field(
        "What the file holds and in which version, such as uictest/scenario/1.", alias="schema"
    )
    name: Slug = field("Name in every report: lower-case letters, digits, dots, dashes and underscores.")
    title: str = field("One line for people.", default="", max_length=200, pattern=r"^[^\x00-\x1f\x7f]*$")


class TestFile(NamedFile):
    """A file of stops that are judged: one case or series, or several that differ in values at keys."""

    __test__ = False

    description: str = field(
        "What it is for.", default="", max_length=5000, pattern=r"^[^\x00-\x08\x0b-\x1f\x7f]*$"
    )
    tags: tuple[Slug, ...] = field("Words that select it (-m).", default=(), max_length=32)
    requirements: RequirementIds = field("Ids of the requirements that it verifies.", default=())
    test_case: RequirementId | None = optional(
        "Id of the test case in the test management tool, such as WSP-TC-7."
    )
    firm: bool = field(
        "Whether `uictest run` finds out how firm the verdicts are, as with --firm.",
        default=False,
        strict=True,
    )
    matrix: dict[str, Any] | None = optional(
        "Lists of values by dotted key; every combination is a case, or a series, first key slowest."
    )
    zip: dict[str, Any] | None = optional(
        "Lists of equal length by dotted key; values at the same place make one."
    )
    include: tuple[dict[str, Any], ...] | None = optional(
        "Further ones, each a mapping of dotted keys to values."
    )
    exclude: tuple[dict[str, Any], ...] | None = optional(
        "Those to leave out: the ones with exactly these values."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield requirements named twice."""
        yield from repeated_requirements(self.requirements)


MOST_REPEATS: Final = 1000
LARGEST_SEED: Final = 2**32 - 1
_WORDS: Final = ("all", "median")
Repeat = Annotated[
    int,
    Field(
        ge=1,
        le=MOST_REPEATS,
        strict=True,
        description="How many times the stop is run: under this seed and those that follow it.",
    ),
]
"""The number of stops of a case."""


class ShareOfStops(Model):
    """A share of the stops that must come out as expected."""

    at_least: Quantity = quantity(
        "Least share of the stops that must come out as expected.", "share", "> 0 % .. 100 %"
    )


def _require_known_word(word: object) -> object:
    if isinstance(word, str) and word not in _WORDS:
        message = f"unknown value {quoted(word)}, expected one of {', '.join(_WORDS)}"
        raise refused(message, "write {at_least: 90 %} for a share of the stops")
    return word


OutcomeOfRepeats = Annotated[
    Annotated[Literal["all", "median"], BeforeValidator(_require_known_word), Tag("word")]
    | Annotated[ShareOfStops, Tag("share")],
    Discriminator(lambda value: "share" if isinstance(value, dict | ShareOfStops) else "word"),
    Field(
        description="What must come out as expected: all stops, the median of each criterion's value, or a"
        " share of the stops, as in `{at_least: 90 %}`."
    ),
]
"""`all` stops, the `median` of each criterion's value, or a share of the stops."""


def seeds_too_large(seed: int, repeat: int) -> Iterator[Inconsistency]:
    """Yield repeats whose last seed is beyond the largest one."""
    last = seed + repeat - 1
    if last > LARGEST_SEED:
        yield Inconsistency(
            ("repeat",),
            f"{repeat} stops from seed {seed} end with seed {last}; the largest is {LARGEST_SEED}",
            f"take a seed of at most {LARGEST_SEED - repeat + 1}",
        )


ExpectedOutcome = Literal["pass", "fail", "invalid", "skipped"]
_OUTCOMES: Final[tuple[ExpectedOutcome, ...]] = get_args(ExpectedOutcome)
_LAYERS: Final = {"fail": "requirement", "invalid": "validity"}
"""Key of an expectation -> layer of the criteria whose ids stand under it."""
_ALLOWANCE: Final = "of_another_controller"
_EXAMPLE: Final = "write one of pass, fail, invalid, skipped, or `{fail: [locked-wheels]}`"


@dataclass(frozen=True, slots=True)
class Expectation:
    """Expected outcome of a case.

    Args:
        outcome: the expected one.
        fail: ids of the requirements that may be missed, of which one at least must be; empty: any.
        invalid: the same of the criteria of validity.
        is_allowance: whether it was written for another controller than that of the case: then what it names
            may be missed, and need not be.

    """

    outcome: ExpectedOutcome = "pass"
    fail: tuple[str, ...] = ()
    invalid: tuple[str, ...] = ()
    is_allowance: bool = False

    @property
    def names_criteria(self) -> bool:
        """Whether it names criteria that may be missed."""
        return bool(self.fail or self.invalid)

    @property
    def lacks_names(self) -> bool:
        """Whether it expects a failure, or no test, without saying by which criterion."""
        return self.outcome in _LAYERS and not self.names_criteria

    def of_another_controller(self) -> Expectation:
        """Return the expectation for another controller: named criteria may be missed; else `pass`."""
        if self.outcome not in _LAYERS:
            return self
        return replace(self, is_allowance=True) if self.names_criteria else Expectation()

    def form(self) -> str | dict[str, Any]:
        """Return it as written in a scenario."""
        names = {key: list(own) for key in _LAYERS if (own := getattr(self, key))}
        return names or self.outcome

    def __str__(self) -> str:
        """Return it for a reader: `pass`, `fail (locked-wheels)`, `pass or fail (locked-wheels)`."""
        named = ", ".join([*self.fail, *self.invalid])
        text = f"{self.outcome} ({named})" if named else self.outcome
        return f"pass or {text}" if self.is_allowance else text

    def unknown_names(self, profiles: Iterable[Any]) -> Iterator[Inconsistency]:
        """Yield each name that is not a criterion of these profiles, or is one of another layer."""
        criteria = [criterion for profile in profiles for criterion in profile.criteria]
        for key, layer in _LAYERS.items():
            known = [each.id for each in criteria if each.layer == layer]
            for name in getattr(self, key):
                if name not in known:
                    others = [each.layer for each in criteria if each.id == name]
                    what = f"has the layer {others[0]}" if others else "is no criterion of this scenario"
                    message = f"`{key}` takes criteria of the layer {layer}; {quoted(name)} {what}"
                    hint = suggestion(name, known) or "there is none in the profiles of this scenario"
                    yield Inconsistency(("expect",), message, hint)


PASS: Final = Expectation()


def expectation_of(content: object) -> Expectation:
    """Return the expectation that a scenario writes. Raises an error of validation."""
    if isinstance(content, Expectation):
        return content
    if (outcome := next((each for each in _OUTCOMES if each == content), None)) is not None:
        return Expectation(outcome)
    if not isinstance(content, Mapping):
        found = quoted(content) if isinstance(content, str) else json.dumps(content, default=str)
        raise refused(f"unknown value {found}, expected one of {', '.join(_OUTCOMES)}", _EXAMPLE)
    names = {key: _names_under(key, value) for key, value in content.items()}
    if not names:
        raise refused("an empty mapping names no criterion", _EXAMPLE)
    outcome = "fail" if "fail" in names else "invalid"
    return Expectation(outcome, names.get("fail", ()), names.get("invalid", ()))


def _of_result(content: object) -> Expectation:
    if not (isinstance(content, Mapping) and content.get(_ALLOWANCE) is True):
        return expectation_of(content)
    names = {key: value for key, value in content.items() if key != _ALLOWANCE}
    return expectation_of(names).of_another_controller()


def _in_result(expect: Expectation) -> str | dict[str, Any]:
    form = expect.form()
    return {**form, _ALLOWANCE: True} if expect.is_allowance and isinstance(form, dict) else form


def _names_under(key: object, value: object) -> tuple[str, ...]:
    if key not in _LAYERS:
        raise refused(f"unknown key {quoted(str(key))}, expected {' or '.join(_LAYERS)}", _EXAMPLE)
    names = list(value) if isinstance(value, list | tuple) else []
    if not names or not all(isinstance(each, str) for each in names):
        raise refused(f"`{key}` lists ids of criteria of {_LAYERS[str(key)]}, at least one", _EXAMPLE)
    return tuple(dict.fromkeys(names))


_ID_LIST: Final = {"type": "array", "minItems": 1, "items": {"type": "string", "pattern": NAME_PATTERN}}
_NAMED: Final = {
    key: {**_ID_LIST, "description": f"Ids of criteria of {layer} that may be missed; one at least must be."}
    for key, layer in _LAYERS.items()
}
Expect = Annotated[
    Expectation,
    PlainValidator(expectation_of),
    PlainSerializer(Expectation.form),
    WithJsonSchema(
        {
            "anyOf": [
                {"enum": list(_OUTCOMES)},
                {"type": "object", "properties": _NAMED, "additionalProperties": False, "minProperties": 1},
            ]
        }
    ),
]
"""The expectation in a scenario: one of the four words, or the names of what may be missed."""
WrittenExpectation = Annotated[Expectation, PlainValidator(_of_result), PlainSerializer(_in_result)]
"""In results an allowance is marked as one."""
LARGEST: Final = 16 * 1024 * 1024
"""Largest file that is read, bytes: exports hold the texts of the requirements as well."""
_COLUMN: Final = "id"
_HINT: Final = "an id has letters, digits and . _ - : / only, and starts with a letter or digit"
_Ids = Iterator[tuple[str, Location]]


def read_requirement_list(path: Path) -> tuple[str, ...]:
    """Return the ids in a list of requirements, each once, in the order of the file.

    `.csv`: the column `id`, separated by comma, semicolon or tab; rows without an id are skipped. `.yaml` or
    `.yml`: a list of ids, or of mappings with a key `id`. Any other file: one id per line, `#` begins a
    comment. Raises ScenarioErrors with every line that is wrong.
    """
    document = read_document(path, LARGEST, "is this a list of requirements?")
    read = {".csv": _csv_ids, ".yaml": _yaml_ids, ".yml": _yaml_ids}.get(path.suffix.lower(), _text_ids)
    found = list(read(document))
    wrong = [
        diagnose(location, f"{quoted(text)} is not the id of a requirement", hint=_HINT)
        for text, location in found
        if not re.fullmatch(REQUIREMENT_PATTERN, text)
    ]
    require_none(wrong)
    if not found:
        raise single_error(Location(document), "the list has no requirement")
    return tuple(dict.fromkeys(text for text, _ in found))


def _text_ids(document: Document) -> _Ids:
    for number, line in enumerate(document.lines, start=1):
        text = line.removeprefix("\ufeff").partition("#")[0]
        if text.strip():
            yield text.strip(), Location(document, number, len(text) - len(text.lstrip()) + 1)


def _csv_ids(document: Document) -> _Ids:
    lines = document.text.removeprefix("\ufeff").splitlines(keepends=True)
    delimiter, column = _id_column(document, lines[0] if lines else "")
    rows = csv.reader(lines, delimiter=delimiter)
    first = 1
    try:
        for row in rows:
            if first > 1 and len(row) > column and row[column].strip():
                yield row[column].strip(), Location(document, first)
            first = rows.line_num + 1
    except csv.Error as error:
        raise single_error(Location(document, rows.line_num), f"cannot be read as CSV: {error}") from None


def _id_column(document: Document, header: str) -> tuple[str, int]:
    for delimiter in ",;\t":
        names = [name.strip().lower() for name in next(csv.reader([header], delimiter=delimiter), [])]
        if _COLUMN in names:
            return delimiter, names.index(_COLUMN)
    raise single_error(Location(document), f"the first row names no column {quoted(_COLUMN)}")


def _yaml_ids(document: Document) -> _Ids:
    root = parse(document, beginning="write a list of ids")
    if not isinstance(root, List):
        raise single_error(root.location, f"expected a list of ids, found {describe(root)}")
    for item in root.items:
        node = item.get(_COLUMN) if isinstance(item, Map) else item
        if not isinstance(node, Scalar):
            expected = f"expected an id, or a mapping with the key {quoted(_COLUMN)}"
            raise single_error(item.location, f"{expected}, found {describe(item)}")
        yield node.text, node.location


_NUMBERS = re.compile(r"([0-9]+)")


def named_requirements(scenario: Any) -> tuple[str, ...]:
    """Return the ids of the requirements that a resolved scenario or one of its criteria names, each once.

    Criteria that only a series can be judged by are left out.
    """
    criteria = (each for profile in scenario.criteria for each in profile.criteria if not each.needs_series)
    of_criteria = (requirement for criterion in criteria for requirement in criterion.requirements)
    return tuple(dict.fromkeys((*scenario.requirements, *of_criteria)))


def in_order_of_ids(requirements: Iterable[str]) -> list[str]:
    """Return ids in alphabetical order, numbers within them by value: BR-9 before BR-10."""
    return sorted(requirements, key=lambda text: (_split_at_numbers(text), text))


def _split_at_numbers(text: str) -> list[str | int]:
    return [int(part) if index % 2 else part for index, part in enumerate(_NUMBERS.split(text))]
