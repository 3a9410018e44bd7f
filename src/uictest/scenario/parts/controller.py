"""The WSP controller under test: a model for each controller that there is, made from its declaration."""

from collections.abc import Iterator
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, create_model

from uictest.controllers import CONTROLLERS, DEFAULT, Controller as Declaration, ControllerParameters
from uictest.record import fields_of
from uictest.scenario.yaml import Inconsistency, Part, Quantity, of_kind


class ControllerPart(Part):
    """What every controller has."""

    folder: ClassVar[str] = "controllers"
    declaration: ClassVar[Declaration]

    schema_id: Literal["uictest/controller/1"] = Field(
        default="uictest/controller/1",
        alias="schema",
        description="What the file holds: uictest/controller/1.",
    )
    if TYPE_CHECKING:  # fields that every model gets from its declaration
        algorithm: str
        cycle_time: Quantity

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield parameters that are impossible together."""
        yield from super().inconsistencies()
        texts = {name: getattr(self, name).text for name in self.declaration.declared_parameters()}
        for conflict in self.declaration.conflicts(self):
            yield Inconsistency((conflict.parameter,), conflict.message.format(**texts))


def _model(controller: Declaration) -> type[ControllerPart]:
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
    model: type[ControllerPart] = create_model(
        "".join(word.capitalize() for word in controller.name.split("-")) + "Controller",
        __base__=ControllerPart,
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

if TYPE_CHECKING:
    Controller = ControllerPart
else:
    Controller = Annotated[reduce(or_, CONTROLLER_MODELS.values()), Field(discriminator="algorithm")]
    """A controller of any algorithm."""
