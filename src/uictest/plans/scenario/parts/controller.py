"""The WSP controller under test: built in, each model made from its declaration, or from outside."""

from collections.abc import Iterator, Mapping
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, create_model

from uictest.controllers import CONTROLLERS, DEFAULT, Controller as Declaration, ControllerParameters
from uictest.core.record import fields_of
from uictest.plans.scenario.parts.controller_choice import one_controller
from uictest.plans.scenario.parts.controller_part import ControllerPart
from uictest.plans.scenario.parts.external_controller import EXTERNAL_MODELS, ExternalController
from uictest.plans.scenario.yaml import Inconsistency, Quantity, of_kind


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
            Annotated[Quantity, of_kind(declared.kind, at_least=declared.at_least, at_most=declared.at_most)],
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
