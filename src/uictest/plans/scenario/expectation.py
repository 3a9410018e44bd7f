"""How a case is expected to come out: an outcome, or the criteria that it may miss by name."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, Final, Literal, get_args

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from uictest.plans.scenario.parts.criteria import Criteria
from uictest.plans.scenario.parts.reading import ID
from uictest.plans.scenario.yaml import Inconsistency, quoted, suggestion

ExpectedOutcome = Literal["pass", "fail", "invalid", "skipped"]
_OUTCOMES: Final[tuple[ExpectedOutcome, ...]] = get_args(ExpectedOutcome)
_LAYERS: Final = {"fail": "requirement", "invalid": "validity"}
"""What the names under a key are: ids of criteria of this layer."""
_ALLOWANCE: Final = "of_another_controller"
_NONE_THERE: Final = "there is none in the profiles of this scenario"
_EXAMPLE: Final = "write one of pass, fail, invalid, skipped, or `{fail: [locked-wheels]}`"


@dataclass(frozen=True, slots=True)
class Expectation:
    """How a case is expected to come out.

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
        """Whether it names what may be missed."""
        return bool(self.fail or self.invalid)

    @property
    def lacks_names(self) -> bool:
        """Whether it expects a failure, or no test, without saying by which criterion."""
        return self.outcome in _LAYERS and not self.names_criteria

    def of_another_controller(self) -> Expectation:
        """Return what of it holds for another controller: what it names, as an allowance, else `pass`."""
        if self.outcome not in _LAYERS:
            return self
        return replace(self, is_allowance=True) if self.names_criteria else Expectation()

    def form(self) -> str | dict[str, Any]:
        """Return what a scenario writes for it."""
        names = {key: list(own) for key in _LAYERS if (own := getattr(self, key))}
        return names or self.outcome

    def __str__(self) -> str:
        """Return it for a reader: `pass`, `fail (locked-wheels)`, `pass or fail (locked-wheels)`."""
        named = ", ".join([*self.fail, *self.invalid])
        text = f"{self.outcome} ({named})" if named else self.outcome
        return f"pass or {text}" if self.is_allowance else text

    def unknown_names(self, profiles: Iterable[Criteria]) -> Iterator[Inconsistency]:
        """Yield each name that is no criterion of these profiles, or one of another layer."""
        criteria = [criterion for profile in profiles for criterion in profile.criteria]
        for key, layer in _LAYERS.items():
            known = [each.id for each in criteria if each.layer == layer]
            for name in getattr(self, key):
                if name not in known:
                    others = [each.layer for each in criteria if each.id == name]
                    what = f"is one of {others[0]}" if others else "is not there"
                    message = f"`{key}` names criteria of {layer}; {quoted(name)} {what}"
                    yield Inconsistency(("expect",), message, suggestion(name, known) or _NONE_THERE)


PASS: Final = Expectation()


def expectation_of(content: object) -> Expectation:
    """Return the expectation that a scenario writes. Raises PydanticCustomError."""
    if isinstance(content, Expectation):
        return content
    if (outcome := next((each for each in _OUTCOMES if each == content), None)) is not None:
        return Expectation(outcome)
    if not isinstance(content, Mapping):
        found = quoted(content) if isinstance(content, str) else json.dumps(content, default=str)
        raise _error(f"unknown value {found}, expected one of {', '.join(_OUTCOMES)}")
    names = {key: _names(key, value) for key, value in content.items()}
    if not names:
        raise _error("an empty mapping names no criterion")
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


def _names(key: object, value: object) -> tuple[str, ...]:
    if key not in _LAYERS:
        raise _error(f"unknown key {quoted(str(key))}, expected {' or '.join(_LAYERS)}")
    names = list(value) if isinstance(value, list | tuple) else []
    if not names or not all(isinstance(each, str) for each in names):
        raise _error(f"`{key}` lists ids of criteria of {_LAYERS[str(key)]}, at least one")
    return tuple(dict.fromkeys(names))


def _error(message: str) -> PydanticCustomError:
    return PydanticCustomError("expectation", "{message}", {"message": message, "hint": _EXAMPLE})


_ID_LIST: Final = {"type": "array", "minItems": 1, "items": {"type": "string", "pattern": ID}}
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
                {
                    "type": "object",
                    "properties": _NAMED,
                    "additionalProperties": False,
                    "minProperties": 1,
                },
            ]
        }
    ),
]
"""The expectation in a scenario: one of the four words, or the names of what may be missed."""
WrittenExpectation = Annotated[Expectation, PlainValidator(_of_result), PlainSerializer(_in_result)]
"""In results an allowance is marked as one."""
