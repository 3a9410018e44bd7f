"""The WSP controller under test: built in, or a program from outside."""

import json
import math
import re
from collections.abc import Iterator, Mapping
from functools import reduce
from operator import or_
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal, Self

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    GetJsonSchemaHandler,
    Tag,
    WithJsonSchema,
    create_model,
)
from pydantic.functional_validators import PlainValidator
from pydantic_core import CoreSchema, PydanticCustomError

from uictest.controllers import (
    CONTROLLERS,
    DEFAULT,
    LONGEST_VERSION,
    Controller as Declaration,
    ControllerParameters,
    ControllerProgram,
    Kind,
    parameter_problems,
)
from uictest.core.record import fields_of
from uictest.plans.scenario.yaml import (
    Document,
    Inconsistency,
    Part,
    Quantity,
    Section,
    accepted_keys,
    field,
    nearest,
    optional,
    quantity,
    quoted,
    refused,
    schema_field,
)

_NOWHERE: Final = Document("", Path(), "")


class ProgramFile(str):
    """The path of a program as a scenario writes it, with where the file lies and what it holds."""

    __slots__ = ("document", "location", "version")

    location: str
    document: Document
    version: str

    def __new__(cls, text: str, location: str = "", document: Document = _NOWHERE, version: str = "") -> Self:
        """A path as written; ``location`` is absolute, ``document`` has the SHA-256 of the content.

        ``version`` is what the file states, empty where it states none.
        """
        file = super().__new__(cls, text)
        file.location = location
        file.document = document
        file.version = version
        return file

    def __getnewargs__(self) -> tuple[str, str, Document, str]:  # type: ignore[override]
        return str.__str__(self), self.location, self.document, self.version

    @property
    def sha256(self) -> str:
        """Of the content."""
        return self.document.sha256


class ControllerPart(Part):
    """Fields of every controller."""

    folder: ClassVar[str] = "controllers"

    schema_id: Literal["uictest/controller/1"] = schema_field("uictest/controller/1")
    if TYPE_CHECKING:  # declared by the models, the first by those of controllers that are built in
        algorithm: str
        cycle_time: Quantity

    @property
    def program(self) -> ControllerProgram | None:
        """Program of a controller from outside; None for a built-in one."""
        return None


def _parse_parameter(value: object) -> Any:
    """Return a value of JSON; a number that remembers how it was written stays one."""
    if isinstance(value, float) and not math.isfinite(value):
        raise refused(f"JSON has no number {value}", "write a finite number, or a text")
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, list | tuple):
        return tuple(_parse_parameter(each) for each in value)
    if isinstance(value, Mapping):
        return {str(name): _parse_parameter(each) for name, each in value.items()}
    hint = "leave the parameter out" if value is None else ""
    raise refused("expected a number, a text, true, false, a list or a mapping", hint)


_JSON: Final[dict[str, Any]] = {"type": ["number", "string", "boolean", "array", "object"]}
ParameterValue = Annotated[Any, PlainValidator(_parse_parameter), WithJsonSchema(_JSON)]
Bound = Annotated[float, Field(strict=True, allow_inf_nan=False)]


class DeclaredParameter(Section):
    """Unit, default and range of a parameter."""

    default: ParameterValue = field("Handed to the controller where nobody gives the parameter.")
    unit: Annotated[str, BeforeValidator(lambda unit: "1" if unit == 1 and unit is not True else unit)] = (
        field("Unit of a number, for people; 1 for a pure number.", default="", max_length=20)
    )
    range: tuple[Bound, Bound] | None = optional(
        "Smallest and largest value that is accepted; any if left out."
    )
    description: str = field("One line for people.", default="", max_length=500)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a number without a unit, a range upside down, and a default outside of it."""
        numbers = self.default if isinstance(self.default, tuple) else (self.default,)
        if not self.unit and all(
            type(each) is not bool and isinstance(each, int | float) for each in numbers
        ):
            yield Inconsistency(
                (), "a number needs a unit", 'write `unit: s`, or `unit: "1"` for a pure number'
            )
        if self.range is not None and self.range[0] > self.range[1]:
            yield Inconsistency(("range",), "the first number of a range is its smallest", "exchange them")
        for problem in parameter_problems({"default": self}, {"default": self.default}):
            yield Inconsistency(("default",), problem.message, problem.hint)


ADDRESS_PATTERN: Final = r"^tcp://[A-Za-z0-9.\-]+:([0-9]{1,5})$"
_LARGEST_PORT: Final = 65535


def _parse_program_file(value: object) -> ProgramFile:
    if isinstance(value, str):
        return value if isinstance(value, ProgramFile) else ProgramFile(value)
    raise refused("expected the path of a file", "write it relative to this file")


ProgramPath = Annotated[
    ProgramFile, PlainValidator(_parse_program_file), WithJsonSchema({"type": "string", "minLength": 1})
]


def _parse_address(value: object) -> str:
    match = re.fullmatch(ADDRESS_PATTERN, value) if isinstance(value, str) else None
    if match is None:
        raise refused(f"{quoted(str(value))} is not an address", "write tcp://HOST:PORT")
    if not 0 < int(match[1]) <= _LARGEST_PORT:
        raise refused(f"there is no port {match[1]}", f"choose one from 1 to {_LARGEST_PORT}")
    return match[0]


_ADDRESS: Final[dict[str, Any]] = {"type": "string", "pattern": ADDRESS_PATTERN}
Address = Annotated[str, PlainValidator(_parse_address), WithJsonSchema(_ADDRESS)]


class ExternalController(ControllerPart):
    """A controller that is no part of this package; see docs/controllers.md."""

    kind: ClassVar[Kind]

    cycle_time: Quantity = quantity("Time between two decisions.", "time", "1 ms .. 1 s", default="10 ms")
    time_limit: Quantity = quantity(
        "Longest time for one answer; a controller that takes longer ends its case as an error.",
        "time",
        "1 ms .. 600 s",
        default="5 s",
    )
    version: str | None = optional(
        "Version of the program, for reports; default: what its file or package states, if any.",
        min_length=1,
        max_length=LONGEST_VERSION,
    )
    parameters: dict[str, ParameterValue] = field(
        "Handed to the controller as JSON, before a stop.", default_factory=dict
    )
    declared_parameters: dict[str, DeclaredParameter] = field(
        "The parameters that it knows; default: what its file declares. Others are errors.",
        default_factory=dict,
    )
    free_parameters: bool = field(
        "Whether parameters that nobody has declared are accepted.", default=False, strict=True
    )

    @property
    def reference(self) -> str:
        """Reference to the program: the value of the key that is named like the kind."""
        return str.__str__(getattr(self, self.kind))

    @property
    def label(self) -> str:
        """Its name; without one, what the program is called."""
        return self.name if "name" in self.model_fields_set else self.program_name

    @property
    def program_name(self) -> str:
        """Name of the program: its file without folder and suffix, unless a kind overrides it."""
        return PurePosixPath(self.reference).stem

    @property
    def options(self) -> dict[str, Any]:
        """Options that only this kind has."""
        return {}

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Require what names the program, but for a mapping that extends another one."""
        schema = super().__get_pydantic_json_schema__(core, handler)
        required = [field.alias or name for name, field in cls.model_fields.items() if field.is_required()]
        schema["anyOf"] = [{"required": required}, {"required": ["extends"]}]
        return schema

    @property
    def program(self) -> ControllerProgram:
        """Program to load."""
        value = getattr(self, self.kind)
        # What is known of its parameters: any are accepted, they are declared, or it is asked in a run.
        knowledge = "free" if self.free_parameters else "declared" if self.declared_parameters else "asked"
        return ControllerProgram(
            kind=self.kind,
            location=getattr(value, "location", "") or str(value),
            sha256=getattr(value, "sha256", ""),
            parameters=json.dumps(self.parameters),
            options={**self.options, "parameters": knowledge},
            time_limit=float(self.time_limit),
        )


class PythonController(ExternalController):
    """A class in a Python file."""

    kind: ClassVar[Kind] = "python"
    tag: ClassVar[str] = "controller of kind python"

    python: ProgramPath = field("Path of the Python file, relative to this file.")
    class_name: str = field("Name of the class in that file.", alias="class", min_length=1)

    @property
    def program_name(self) -> str:
        """The name of the class."""
        return self.class_name

    @property
    def options(self) -> dict[str, Any]:
        """The name of the class."""
        return {"class": self.class_name}


class LibraryController(ExternalController):
    """A shared library with the functions of uictest_controller.h."""

    kind: ClassVar[Kind] = "library"
    tag: ClassVar[str] = "controller of kind library"

    library: ProgramPath = field("Path of the shared library, relative to this file.")


class FmuController(ExternalController):
    """A functional mock-up unit for co-simulation, FMI 2.0 or 3.0."""

    kind: ClassVar[Kind] = "fmu"
    tag: ClassVar[str] = "controller of kind fmu"

    fmu: ProgramPath = field("Path of the FMU, relative to this file.")
    variables: dict[str, str] = field(
        "Names of its variables by ours, such as wheel_speed: axle_speed_%d; %d stands for the"
        " number of the wheelset. A variable that is left out has our name with _%d.",
        default_factory=dict,
    )

    @property
    def options(self) -> dict[str, Any]:
        """The names of its variables."""
        return {"variables": dict(self.variables)}


class SocketController(ExternalController):
    """A program that listens on a TCP port."""

    kind: ClassVar[Kind] = "connect"
    tag: ClassVar[str] = "controller of kind connect"

    connect: Address = field("Where it listens, such as tcp://127.0.0.1:5025.")

    @property
    def program_name(self) -> str:
        """Its address."""
        return self.connect


class RegisteredController(ExternalController):
    """A controller of an installed package, by its name in the entry points uictest.controllers."""

    kind: ClassVar[Kind] = "registered"
    tag: ClassVar[str] = "controller of kind registered"

    registered: str = field("Name that the package has registered.", min_length=1)

    @property
    def program_name(self) -> str:
        """The name that the package has registered."""
        return self.registered


EXTERNAL_MODELS: Final[dict[str, type[ExternalController]]] = {
    model.kind: model
    for model in (PythonController, LibraryController, FmuController, SocketController, RegisteredController)
}
"""Models by the key that names the program."""
_ALGORITHM: Final = "algorithm"
_NAMES: Final = (_ALGORITHM, *EXTERNAL_MODELS)
"""Keys of which a controller has exactly one."""


def one_controller(value: object) -> object:
    """Return a mapping that names one controller; raise PydanticCustomError for any other mapping."""
    problem = _problem_of_mapping(value) if isinstance(value, Mapping) else None
    if problem is not None:
        context = {"message": problem.message, "inconsistencies": [problem]}
        raise PydanticCustomError("inconsistency", "{message}", context)
    return value


def _problem_of_mapping(mapping: Mapping[str, object]) -> Inconsistency | None:
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
    """Fields of every controller of this package."""

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
        name: (Quantity, quantity(each.description, each.kind, f"{each.at_least} .. {each.at_most}"))
        for name, each in controller.declared_parameters().items()
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


def __getattr__(name: str) -> type[BuiltInController]:
    """Return a model by its name, where pickle looks for it: sweeps send scenarios to other processes."""
    for model in CONTROLLER_MODELS.values():
        if model.__name__ == name:
            return model
    raise AttributeError(name)


_BUILT_IN = "built in"


def _tag_of_kind(value: object) -> str:
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
    Controller = Annotated[_union, Discriminator(_tag_of_kind), BeforeValidator(one_controller)]
    """A controller of any algorithm, or from outside."""
