"""Controllers from outside: the program under test, its parameters."""

import json
import math
import re
from collections.abc import Iterator, Mapping
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal

from pydantic import BeforeValidator, Field, GetJsonSchemaHandler, WithJsonSchema
from pydantic.functional_validators import PlainValidator
from pydantic_core import CoreSchema, PydanticCustomError

from uictest.controllers import LONGEST_VERSION, ControllerProgram, Kind, parameter_problems
from uictest.plans.scenario.program_files import ProgramFile
from uictest.plans.scenario.yaml import Inconsistency, Part, Quantity, Section, quoted
from uictest.plans.scenario.yaml.quantity_field import field, optional, quantity, schema_field


class ControllerPart(Part):
    """What every controller has."""

    folder: ClassVar[str] = "controllers"

    schema_id: Literal["uictest/controller/1"] = schema_field("uictest/controller/1")
    if TYPE_CHECKING:  # declared by the models, the first by those of controllers that are built in
        algorithm: str
        cycle_time: Quantity

    @property
    def program(self) -> ControllerProgram | None:
        """What is loaded where the controller comes from outside, None where it is built in."""
        return None


def _parameter(value: object) -> Any:
    """Return a value of JSON; a number that remembers how it was written stays one."""
    if isinstance(value, float) and not math.isfinite(value):
        context = {"message": f"JSON has no number {value}", "hint": "write a finite number, or a text"}
        raise PydanticCustomError("parameter", "{message}", context)
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, list | tuple):
        return tuple(_parameter(each) for each in value)
    if isinstance(value, Mapping):
        return {str(name): _parameter(each) for name, each in value.items()}
    hint = "leave the parameter out" if value is None else ""
    context = {"message": "expected a number, a text, true, false, a list or a mapping", "hint": hint}
    raise PydanticCustomError("parameter", "{message}", context)


_JSON: Final[dict[str, Any]] = {"type": ["number", "string", "boolean", "array", "object"]}
ParameterValue = Annotated[Any, PlainValidator(_parameter), WithJsonSchema(_JSON)]


Bound = Annotated[float, Field(strict=True, allow_inf_nan=False)]


def _unit(value: object) -> object:
    return "1" if value == 1 and not isinstance(value, bool) else value


class DeclaredParameter(Section):
    """What a parameter is measured in, what it is where nobody gives it, and what it may be."""

    default: ParameterValue = field("Handed to the controller where nobody gives the parameter.")
    unit: Annotated[str, BeforeValidator(_unit)] = field(
        "Unit of a number, for people; 1 for a pure number.", default="", max_length=20
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


def _file(value: object) -> ProgramFile:
    if isinstance(value, str):
        return value if isinstance(value, ProgramFile) else ProgramFile(value)
    context = {"message": "expected the path of a file", "hint": "write it relative to this file"}
    raise PydanticCustomError("program_file", "{message}", context)


ProgramPath = Annotated[
    ProgramFile, PlainValidator(_file), WithJsonSchema({"type": "string", "minLength": 1})
]


def _address(value: object) -> str:
    match = re.fullmatch(ADDRESS_PATTERN, value) if isinstance(value, str) else None
    if match is None:
        context = {"message": f"{quoted(str(value))} is not an address", "hint": "write tcp://HOST:PORT"}
        raise PydanticCustomError("address", "{message}", context)
    if not 0 < int(match[1]) <= _LARGEST_PORT:
        context = {"message": f"there is no port {match[1]}", "hint": f"choose one from 1 to {_LARGEST_PORT}"}
        raise PydanticCustomError("address", "{message}", context)
    return match[0]


_ADDRESS: Final[dict[str, Any]] = {"type": "string", "pattern": ADDRESS_PATTERN}
Address = Annotated[str, PlainValidator(_address), WithJsonSchema(_ADDRESS)]


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
        """What names the program: the value of the key that is called as the kind."""
        return str.__str__(getattr(self, self.kind))

    @property
    def label(self) -> str:
        """Its name; without one, what the program is called."""
        return self.name if "name" in self.model_fields_set else self.program_name

    @property
    def program_name(self) -> str:
        """What the program is called: its file without folder and ending, unless a kind says it better."""
        return PurePosixPath(self.reference).stem

    @property
    def options(self) -> dict[str, Any]:
        """What only this kind has."""
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
        """What is loaded."""
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
    for model in (
        PythonController,
        LibraryController,
        FmuController,
        SocketController,
        RegisteredController,
    )
}
"""Models by the key that names the program."""
