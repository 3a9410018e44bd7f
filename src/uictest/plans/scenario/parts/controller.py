"""The WSP controller under test: built in, each model made from its declaration, or from outside."""

from collections.abc import Iterator, Mapping
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, create_model
from pydantic_core import PydanticCustomError

from uictest.controllers import CONTROLLERS, DEFAULT, Controller as Declaration, ControllerParameters
from uictest.core.record import fields_of
from uictest.plans.scenario.parts.external_controller import (
    EXTERNAL_MODELS,
    ControllerPart,
    ExternalController,
)
from uictest.plans.scenario.yaml import Inconsistency, Quantity, accepted_keys, nearest, quoted
from uictest.plans.scenario.yaml.quantity_field import of_kind

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


class BuiltInController(ControllerPart):
    """What every controller of this package has."""

    declaration: ClassVar[Declaration]

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield parameters that are impossible together."""
        yield from super().inconsistencies()
        texts = {name: getattr(self, name).text for name in self.declaration.declared_parameters()}
        for conflict in self.declaration.conflicts(self):
            yield Inconsistency((conflict.parameter,), conflict.message.format(**texts))


def _model(controller: Declaration) -> type[BuiltInController]:
    """Return the model of a controller's parameters; those that every controller has come first."""
    fields: dict[str, Any] = {
        name: (
            Annotated[Quantity, of_kind(declared.kind, f"{declared.at_least} .. {declared.at_most}")],
            Field(description=declared.description),
        )
        for name, declared in controller.declared_parameters().items()
    }
    algorithm = (Literal[controller.name], Field(description="The algorithm that reads these numbers."))
    common = {name: fields.pop(name) for name in fields_of(ControllerParameters)}
    model: type[BuiltInController] = create_model(
        "".join(word.capitalize() for word in controller.name.split("-")) + "Controller",
        __base__=BuiltInController,
        __doc__=controller.parameters.__doc__,
        __module__=__name__,
        **{**common, "algorithm": algorithm, **fields},
    )
    model.declaration = controller
    return model


CONTROLLER_MODELS = {
    name: _model(CONTROLLERS[name]) for name in sorted(CONTROLLERS, key=lambda name: (name != DEFAULT, name))
}
"""Models by the names of the controllers, the default one first."""
# Pickle finds a class by its name in its module; sweeps send scenarios to other processes.
globals().update({model.__name__: model for model in CONTROLLER_MODELS.values()})

_BUILT_IN = "built in"


def _tag(value: object) -> str:
    """Return which members of the union a mapping is meant for: those with an algorithm, or one other."""
    if isinstance(value, ExternalController):
        return value.tag
    keys = value if isinstance(value, Mapping) else ()
    return next((model.tag for kind, model in EXTERNAL_MODELS.items() if kind in keys), _BUILT_IN)


if TYPE_CHECKING:
    Controller = ControllerPart
else:
    _built_in = Annotated[reduce(or_, CONTROLLER_MODELS.values()), Field(discriminator="algorithm")]
    _external = [Annotated[model, Tag(model.tag)] for model in EXTERNAL_MODELS.values()]
    _union = reduce(or_, _external, Annotated[_built_in, Tag(_BUILT_IN)])
    Controller = Annotated[_union, Discriminator(_tag), BeforeValidator(one_controller)]
    """A controller of any algorithm, or from outside."""
