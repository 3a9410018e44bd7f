"""Which controller a mapping names: exactly one that is built in, or one from outside."""

from collections.abc import Mapping
from typing import Final

from pydantic_core import PydanticCustomError

from uictest.controllers import CONTROLLERS, DEFAULT
from uictest.plans.scenario.parts.external_controller import EXTERNAL_MODELS
from uictest.plans.scenario.yaml import Inconsistency, accepted_keys, nearest, quoted

_ALGORITHM: Final = "algorithm"
_NAMES: Final = (_ALGORITHM, *EXTERNAL_MODELS)
"""Keys of which a controller has exactly one."""


def one_controller(value: object) -> object:
    """Return a mapping that names one controller; raise PydanticCustomError for any other mapping."""
    problem = _problem(value) if isinstance(value, Mapping) else None
    if problem is not None:
        context = {"message": problem.message, "inconsistencies": [problem]}
        raise PydanticCustomError("inconsistency", "{message}", context)
    return value


def _problem(mapping: Mapping[str, object]) -> Inconsistency | None:
    named = [name for name in _NAMES if name in mapping]
    if not named:
        return _none_named(mapping)
    if len(named) == 1:
        return None
    message = f"two controllers are named: by {quoted(named[0])} and by {quoted(named[1])}"
    hint = "keep one of them"
    if named[0] == _ALGORITHM:
        hint = "keep one of them; a controller from outside does not extend one that is built in"
    # An algorithm may come from a library file that is extended: the other one is the user's.
    return Inconsistency((named[1],), message, hint)


def _none_named(mapping: Mapping[str, object]) -> Inconsistency:
    for key in mapping:
        guess = nearest(key, _NAMES) if key not in _KNOWN else None
        if guess is not None:
            return Inconsistency((key,), f"unknown key {quoted(key)}", f"did you mean {quoted(guess)}?")
    own = [key for key in mapping if key not in _COMMON]
    changed = [name for name, known in _PARAMETERS.items() if own and known.issuperset(own)]
    if changed:
        base = DEFAULT if DEFAULT in changed else changed[0]
        hint = f"write `extends: {base}` to change parameters of that controller"
    else:
        programs, built_in = ", ".join(EXTERNAL_MODELS), " or ".join(sorted(CONTROLLERS))
        hint = f"name a program by one of {programs}; or write `extends:` with {built_in}"
    return Inconsistency((), "no controller is named", hint)


_PARAMETERS: Final = {
    name: frozenset(controller.declared_parameters()) for name, controller in CONTROLLERS.items()
}
"""Parameters of the controllers that are built in."""
_COMMON: Final = frozenset({"schema", "name", "title", "sources"})
_KNOWN: Final = _COMMON.union(
    *_PARAMETERS.values(), *(accepted_keys(model, ()) for model in EXTERNAL_MODELS.values())
)
"""Keys that some controller has."""
