"""Base classes of all models of files, and the keys that a model accepts."""

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from operator import attrgetter
from typing import Any, ClassVar, Final, Literal, NamedTuple, Self, TypeVar, get_args, get_origin

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    PrivateAttr,
    TypeAdapter,
)
from pydantic_core import CoreSchema, PydanticCustomError

from uictest.plans.scenario.yaml.diagnostics import quoted, suggestion
from uictest.plans.scenario.yaml.quantities import DEFAULT_SOURCE, SCENARIO_SOURCE, Quantity

Key = tuple[str | int, ...]

NAME_PATTERN: Final = r"^[a-z0-9][a-z0-9._-]{0,99}$"
"""Pattern of the name of a part."""


class Inconsistency(NamedTuple):
    """Values that are valid one by one but impossible together; ``key`` is relative to the model."""

    key: Key
    message: str
    hint: str = ""


_Copied = TypeVar("_Copied", bound=BaseModel)


def _of_fields_alone(copied: _Copied) -> _Copied:
    for name in copied.__dict__.keys() - type(copied).model_fields.keys():
        del copied.__dict__[name]
    return copied


class Model(BaseModel):
    """A mapping of a scenario or of a library file."""

    tag: ClassVar[str] = ""
    """Names the model in a union that a function tells apart; no key of a file may be called so."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    def __copy__(self) -> Self:
        """Return a copy of the fields alone: cached properties are of the values before an update."""
        return _of_fields_alone(super().__copy__())

    def __deepcopy__(self, memo: dict[int, Any] | None = None) -> Self:
        """Return a copy of the fields alone, and of what they hold."""
        return _of_fields_alone(super().__deepcopy__(memo))

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield values that are impossible together."""
        yield from ()

    def undescribed(self) -> Iterator[Inconsistency]:
        """Yield references to descriptions that are missing."""
        yield from ()

    def model_post_init(self, context: object, /) -> None:
        """Raise for what is impossible together, once: an instance inside of another is not made again."""
        inconsistencies = [*self.undescribed(), *self.inconsistencies()]
        if inconsistencies:
            found = {"message": inconsistencies[0].message, "inconsistencies": inconsistencies}
            raise PydanticCustomError("inconsistency", "{message}", found)


class Section(Model):
    """A mapping inside a part; an inline mapping with ``extends`` may leave out some of its keys."""

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        schema = handler.resolve_ref_schema(handler(core))
        schema.pop("required", None)
        return schema


class Source(Model):
    """Source of a number."""

    mark: Literal["stated", "published", "identified", "chosen"] = Field(
        description="stated: in the text of Lee and Kang (2015); published: elsewhere; identified: from a "
        "record; chosen: by us."
    )
    text: str = Field(
        description="The publication and the place in it, the record, or why a chosen value is plausible.",
        min_length=1,
    )


class Part(Model):
    """A part of the rig: a library file, a user's file, or an inline mapping of a scenario."""

    folder: ClassVar[str]
    """Folder of the library that holds parts of this kind."""

    schema_id: str | None = Field(
        default=None,
        alias="schema",
        description="What the file holds and which version of it, e.g. uictest/vehicle/1.",
    )
    name: str = Field(
        default="inline", pattern=NAME_PATTERN, description="Name of the part: lower case, no blanks."
    )
    title: str = Field(default="", max_length=200, description="One line for people.")
    sources: dict[str, Source] = Field(
        default_factory=dict,
        description="Where the numbers come from; each number names a key of this mapping.",
    )

    # Beside the fields, so that a copy with other numbers still knows what it was changed from.
    _based_on: str | None = PrivateAttr(default=None)
    _original: "Part | None" = PrivateAttr(default=None)

    @property
    def based_on(self) -> str | None:
        """Name of the library part at the root of `extends`, else of the file there.

        A library part is based on itself. None for a part that extends nothing.
        """
        return self._based_on

    @property
    def original(self) -> "Part | None":
        """The part called `based_on` as its file has it; None where that file is not a whole part."""
        return self._original

    @property
    def label(self) -> str:
        """Name of the part in reports."""
        return self.name

    def with_origin(self, based_on: str | None, original: "Part | None") -> Self:
        """Return a copy that knows the part it is based on."""
        part = self.model_copy()
        part._based_on, part._original = based_on, original
        return part

    def undescribed(self) -> Iterator[Inconsistency]:
        """Yield every number whose source is not described."""
        for key, source in unknown_sources(quantities_in(self), self.sources):
            hint = suggestion(source, self.sources) or "describe it under 'sources'"
            yield Inconsistency(key, f"unknown source {quoted(source)}", hint)

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Let an inline mapping extend a library part and override only what it names."""
        schema = handler.resolve_ref_schema(handler(core))
        schema.pop("required", None)
        schema["properties"]["extends"] = {
            "type": "string",
            "description": "Library name or relative path of the part that this mapping changes.",
        }
        return schema


_LIBRARY_NAME_OR_PATH = {
    "type": "string",
    "minLength": 1,
    "description": "A library name, or a relative path ending in .yaml.",
}


class PartReference(NamedTuple):
    """Marks a field that refers to a part; ``default`` is the library name used if the key is missing.

    With ``several``, the field also accepts a list of references.
    """

    model: Any
    default: str
    several: bool = False

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return handler(source)

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        if not self.several:
            return {"default": self.default, "anyOf": [_LIBRARY_NAME_OR_PATH, handler(core)]}
        inline = handler(core)["items"]
        listed = {"type": "array", "minItems": 1, "items": {"anyOf": [_LIBRARY_NAME_OR_PATH, inline]}}
        return {"default": self.default, "anyOf": [_LIBRARY_NAME_OR_PATH, inline, listed]}


def unknown_sources(
    quantities: Iterable[tuple[Key, Quantity]], described: Iterable[str]
) -> Iterator[tuple[Key, str]]:
    """Yield each source that a quantity names and that is not described, with the key that names it."""
    known = {SCENARIO_SOURCE, DEFAULT_SOURCE, *described}
    for key, quantity in quantities:
        named = {"source": quantity.source}
        if quantity.range is not None and quantity.range[0].source != quantity.source:
            named["range_source"] = quantity.range[0].source
        yield from (((*key, name), source) for name, source in named.items() if source not in known)


Value = Quantity | str | int | float

DESCRIPTIVE: Final = frozenset(
    {
        *("schema_id", "id", "name", "title", "description", "tags", "extends"),
        *("sources", "source", "clause", "scope", "provenance"),
        *("requirements", "test_case", "validated", "declared_parameters", "free_parameters"),
        *("matrix", "zip", "include", "exclude", "expect", "repeat", "outcome_of_repeats", "firm"),
    }
)
"""Fields that a stop cannot depend on: names, sources, expectations, repeats and references to results.

Declarations of a controller's parameters are among them: their defaults stand in `parameters`.
"""
_SINGLE: Final = frozenset({Quantity, str, int, float, bool})


@cache
def declared_values(model: type[BaseModel]) -> tuple[tuple[Key, str], ...]:
    """Return the key in a file and the dotted attribute of every field that a stop can depend on.

    In place of a section that every instance has stand the fields of the section.
    """
    fields: list[tuple[Key, str]] = []
    for name, field in model.model_fields.items():
        key, inside = field.alias or name, field.annotation
        if name in DESCRIPTIVE:
            continue
        if isinstance(inside, type) and issubclass(inside, Model) and not issubclass(inside, Part):
            fields += [((key, *below), f"{name}.{attribute}") for below, attribute in declared_values(inside)]
        else:
            fields.append(((key,), name))
    return tuple(fields)


_getter: Final = cache(attrgetter)


def _collect(value: object, key: Key, found: list[tuple[Key, Value]], *, parts: bool, ids: bool) -> None:
    if isinstance(value, str | int | float):
        found.append((key, value))
        if (digest := getattr(value, "sha256", None)) is not None:
            found.append(((*key[:-1], "sha256"), digest))
        return
    inside: Iterable[tuple[Key, object]] = ()
    if isinstance(value, BaseModel) and (parts or not key or not isinstance(value, Part)):
        inside = [(below, _getter(name)(value)) for below, name in declared_values(type(value))]
    elif isinstance(value, dict):
        inside = [((name,), inner) for name, inner in value.items()]
    elif isinstance(value, tuple):
        inside = [
            ((getattr(inner, "id", index) if ids else index,), inner) for index, inner in enumerate(value)
        ]
    for below, inner in inside:
        if type(inner) in _SINGLE:
            found.append(((*key, *below), inner))  # type: ignore[arg-type]
        elif inner is not None:
            _collect(inner, (*key, *below), found, parts=parts, ids=ids)


def values_in(value: object, key: Key = ()) -> list[tuple[Key, Value]]:
    """Return every number and setting inside a model, tuple or mapping with its key.

    A criterion is named by its id. Parts inside are skipped, and so are values that are not set. Beside the
    path of a program stands the SHA-256 of its file.
    """
    found: list[tuple[Key, Value]] = []
    _collect(value, key, found, parts=False, ids=True)
    return found


def quantities_in(value: object, key: Key = (), *, parts: bool = True) -> list[tuple[Key, Quantity]]:
    """Return every quantity inside a model, tuple or mapping with its key; of `parts` inside, too."""
    found: list[tuple[Key, Value]] = []
    _collect(value, key, found, parts=parts, ids=False)
    return [(each, number) for each, number in found if isinstance(number, Quantity)]


class DescribedValue(NamedTuple):
    """A number or setting, and what is said of it.

    Attributes:
        elements: of its key.
        key: the same, dotted.
        value: a number in `unit`, a text or a truth value.
        unit: SI, `1` for a pure number, empty for a setting.
        written: the value as a file writes it.
        mark: of the source of a number; `user` for one without, `default` for one that the file leaves out;
            empty for a setting.
        source: a key of the part's `sources`, else empty.
    """

    elements: Key
    key: str
    value: str | int | float
    unit: str
    written: str
    mark: str
    source: str


def described_values(value: object, sources: Mapping[str, Source], key: Key = ()) -> list[DescribedValue]:
    """Return the values of :func:`values_in` with all that is said of them."""
    described: list[DescribedValue] = []
    said: tuple[str | int | float, str, str, str, str]
    for elements, found in values_in(value, key):
        dotted = ".".join(map(str, elements))
        if isinstance(found, Quantity):
            source = found.source if found.source in sources else ""
            said = (float(found), found.unit, found.text, mark_of(found, sources), source)
        else:
            setting = float(found) if isinstance(found, float) else found
            text = str(found).lower() if isinstance(found, bool) else str(found)
            said = (setting, "", text, "", "")
        described.append(DescribedValue(elements, dotted, *said))
    return described


_UNSOURCED: Final = {SCENARIO_SOURCE: "user", DEFAULT_SOURCE: "default"}


def mark_of(quantity: Quantity, sources: Mapping[str, Source]) -> str:
    """Return the mark of the source; `user` for a number without one, `default` for one that a file omits.

    Empty where `sources` are not those of the quantity's part.
    """
    source = sources.get(quantity.source)
    return _UNSOURCED.get(quantity.source, "") if source is None else source.mark


def is_changed(part: Part) -> bool:
    """Return whether a value of a part differs from the part at the root of its `extends`."""
    original = part.original
    return original is not None and dict(values_in(part)) != dict(values_in(original))


@cache
def adapter_of(model: Any) -> TypeAdapter[Any]:
    """Return the validator of a model, built at its first use."""
    if isinstance(model, type) and issubclass(model, BaseModel):
        model.model_rebuild()  # kept for the models that contain this one; an adapter keeps its own
    return TypeAdapter(model)


def accepted_keys(model: Any, key: Key) -> set[str]:
    """The keys that the mapping at ``key`` of a model accepts."""
    names: set[str] = set()
    for each in models_at(model, key):
        names.update(field.alias or name for name, field in each.model_fields.items())
    return names


def fields_named(model: Any, key: Key, name: str) -> Iterator[Any]:
    """Yield the fields called ``name`` of the mapping at ``key`` of a model."""
    for each in models_at(model, key):
        for field_name, field in each.model_fields.items():
            if name in (field_name, field.alias):
                yield field


def models_at(model: Any, key: Key) -> list[Any]:
    """The models that the mapping at ``key`` may be; indices and names in a dict are skipped.

    A tag, which pydantic puts into the key, selects the member of a union.
    """
    here = models_in(model)
    for element in key:
        inner = [
            field.annotation
            for each in here
            for name, field in each.model_fields.items()
            if element in (name, field.alias)
        ]
        within = [inner_model for annotation in inner for inner_model in models_in(annotation)]
        here = within or _members(here, element) or here
    return here


def _members(models: list[Any], tag: str | int) -> list[Any]:
    return [
        each
        for each in models
        if each.tag == tag
        or any(
            get_origin(field.annotation) is Literal and get_args(field.annotation) == (tag,)
            for field in each.model_fields.values()
        )
    ]


def models_in(annotation: Any) -> list[Any]:
    """The models that an annotation names, however deep."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    if get_origin(annotation) is Literal:
        return []
    return [inner_model for inner in get_args(annotation) for inner_model in models_in(inner)]
