"""The channels of recorded stops, and the channel map that says where a file has them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Final, Literal

from pydantic import BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from uictest.core.recording import TIME
from uictest.core.recording.formats import Dialect
from uictest.core.units import ROTATIONAL_SPEEDS, recorded_spellings, recorded_unit_size
from uictest.plans import library
from uictest.plans.scenario import Files, Roots, is_path, schema_of
from uictest.plans.scenario.yaml import (
    Inconsistency,
    Map,
    Model,
    Quantity,
    Scalar,
    field,
    inherit,
    of_kind,
    optional,
    plain,
    quantity,
    quoted,
    read_file,
    single_error,
    suggestion,
    validated,
)
from uictest.rig import CAR_CHANNELS, WHEELSET_CHANNELS

WHEELSETS: Final = (1, 2, 3, 4)
"""Numbers of the wheelsets, from the leading end."""

CHANNEL_UNITS: Final = MappingProxyType(
    {
        **dict(CAR_CHANNELS),
        "brake_command": "1",
        **{f"{name}_{n}": unit for n in WHEELSETS for name, unit in WHEELSET_CHANNELS},
    }
)
"""Canonical channel -> its SI unit. Pressures are gauge, wheel speeds circumferential."""


def of_wheelsets(kind: str) -> tuple[str, ...]:
    """Return the channels of one kind of all wheelsets, as in `wheel_speed_1` .. `wheel_speed_4`."""
    return tuple(f"{kind}_{n}" for n in WHEELSETS)


SCHEMA: Final = "uictest/channel-map/1"
DEFAULT: Final = "uictest"
NUMBER: Final = "{n}"
"""Stands for the number of the wheelset, in the name of a channel and in its sources."""
_USUAL_ENCODINGS: Final = ("utf-8", "cp1252", "latin-1", "utf-16", "cp1250", "cp437", "cp850", "mac_roman")
_PRESETS: Final = Path(library.__file__).parent / "channel_maps"
Trigger = Literal["auto", "stated", "start", "command", "demand", "pressure"]


def _source_of_shorthand(value: object) -> object:
    return {"source": value} if isinstance(value, str | tuple) else value


def _as_list(value: object) -> object:
    return (value,) if isinstance(value, str) else value


_NameOrNames = Annotated[str, Field(min_length=1)] | Annotated[tuple[str, ...], Field(min_length=1)]


_SHORT_NAMES: Final = MappingProxyType({"header": "header_line", "units": "unit_line"})


def _with_short_names(schema: dict[str, Any]) -> None:
    properties = schema["properties"]
    schema["properties"] = properties | {short: properties[name] for short, name in _SHORT_NAMES.items()}


class ChannelSource(Model):
    """Where a channel comes from: value = sign (scale x sample + offset), in `unit`."""

    source: Annotated[tuple[str, ...], BeforeValidator(_as_list, json_schema_input_type=_NameOrNames)] = (
        field(
            "Name in the file, or a list of names: the first one present is used; also group/name. Of `time`,"
            " columns of a date and a clock.",
            default=(),
        )
    )
    unit: str = field("Unit of the value; the file's own if left out.", default="")
    scale: float = field("Factor on every sample.", default=1.0, allow_inf_nan=False)
    offset: float = field("Added after scaling, in `unit`.", default=0.0, allow_inf_nan=False)
    sign: Literal[1, -1] = field("-1 if the file has the opposite sign.", default=1)
    states: dict[str, int] = field("Name of a state in the file -> its number.", default={})
    wheel_radius: Annotated[Quantity, of_kind("length", "50 mm .. 1 m")] | None = optional(
        "Of a speed in rpm: radius of the wheel that turns."
    )
    interval: Annotated[Quantity, of_kind("time", "0.01 ms .. 5 s")] | None = optional(
        "Of `time`, in place of `source`: sampling interval of a file without a column of times."
    )


def _unit_inconsistencies(key: tuple[str, ...], source: ChannelSource) -> Iterator[Inconsistency]:
    name = key[-1]
    of_first = name.replace(NUMBER, str(WHEELSETS[0]))
    if of_first not in CHANNEL_UNITS:
        known = dict.fromkeys(canonical.replace("_1", f"_{NUMBER}") for canonical in CHANNEL_UNITS)
        yield Inconsistency(key, f"unknown channel {quoted(name)}", suggestion(name, known))
        return
    si = CHANNEL_UNITS[of_first]
    rotates = si == "m/s" and source.unit in ROTATIONAL_SPEEDS
    if source.unit and not rotates and recorded_unit_size(source.unit, si) is None:
        accepted = "accepted: " + ", ".join(recorded_spellings(si))
        yield Inconsistency((*key, "unit"), f"{quoted(source.unit)} is not a unit of {name}", accepted)
    if not source.source and source.interval is None:
        wanted = "source: NAME, or interval: 20 ms" if name == TIME else "source: NAME"
        yield Inconsistency(key, f"{name}: no source", f"write {wanted}")
    if source.interval is not None and name != TIME:
        yield Inconsistency((*key, "interval"), "interval: of `time` alone", "it holds for every channel")
    if source.wheel_radius is not None and si != "m/s":
        yield Inconsistency((*key, "wheel_radius"), f"wheel_radius: {name} is no speed")


_NOT_READ: Final = ChannelSource(source=("",))


class DialectSection(Model):
    """How a text file writes its table; lines are counted from one."""

    model_config = ConfigDict(json_schema_extra=_with_short_names)

    delimiter: str = field("Between two cells.", default=",", min_length=1, max_length=1)
    decimal: Literal[".", ","] = field("Before decimals.", default=".")
    thousands: Literal["", ".", ",", "'", " "] = field("Between groups of digits.", default="")
    header_line: int = field("Line of the names; 0: the first.", default=0, ge=0, le=10_000)
    unit_line: int = field("Line of the units; 0: detected, or none.", default=0, ge=0, le=10_000)
    first_line: int = field("First line of samples; 0: the next.", default=0, ge=0, le=10_000)
    encoding: str = field("Encoding of the text.", default="utf-8", max_length=40)
    dates: str = field(
        'How dates or clocks are written, as in "%d.%m.%Y %H:%M:%S.%f"; empty: as ISO 8601.',
        default="",
        max_length=100,
    )
    missing: Annotated[tuple[str, ...], Field(max_length=100)] = field(
        "Marks of missing samples, besides the usual ones.", default=()
    )

    @model_validator(mode="before")
    @classmethod
    def _of_short_names(cls, section: Any) -> Any:
        if not isinstance(section, Mapping):
            return section
        return {_SHORT_NAMES.get(key, key): value for key, value in section.items()}

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield an unknown encoding, and a separator that is also the decimal sign."""
        try:
            "".encode(self.encoding)
        except (LookupError, ValueError):
            hint = suggestion(self.encoding, _USUAL_ENCODINGS)
            yield Inconsistency(("encoding",), f"unknown encoding {quoted(self.encoding)}", hint)
        if self.thousands == self.decimal:
            yield Inconsistency(("thousands",), f"{quoted(self.thousands)} is already the decimal sign")


class Preparation(Model):
    """Trigger, raster, filter and standstill. No published rule exists for any of them: all are chosen."""

    trigger: Trigger = field(
        "What marks the brake command: a time the file states, its start, the brake command, the"
        " demanded pressure or the first pressure to rise; auto takes the first of these that is recorded.",
        default="auto",
    )
    trigger_time: Annotated[Quantity, of_kind("time", "-1e10 s .. 1e10 s")] | None = optional(
        "Time of the brake command in the file; takes the place of `trigger`."
    )
    trigger_lead: Quantity = quantity(
        "Time from the brake command to the event that marks it.", "time", "0 s .. 60 s", default="0 s"
    )
    trigger_pressure: Quantity = quantity(
        "Rise of a pressure that marks the brake command.", "pressure", "> 0 bar .. 10 bar", default="0.1 bar"
    )
    trigger_speed: Quantity = quantity(
        "The train must run faster than this at the trigger.", "speed", "0 km/h .. 600 km/h", default="5 km/h"
    )
    raster: Quantity = quantity(
        "Interval of the samples that are judged; a coarser recording keeps its own.",
        "time",
        "0.1 ms .. 1 s",
        default="10 ms",
    )
    low_pass: Annotated[Quantity, of_kind("frequency", "> 0 Hz .. 100000 Hz")] | None = optional(
        "Corner frequency of a low-pass on every signal, second order, no delay; else none."
    )
    standstill_speed: Quantity = quantity(
        "Below this speed, if no sample of zero follows, the train is assumed to stop at the"
        " deceleration of the last half second.",
        "speed",
        "> 0 km/h .. 10 km/h",
        default="1 km/h",
    )


class ChannelMap(Model):
    """A channel map as it is written, parents merged in."""

    schema_id: Literal["uictest/channel-map/1"] = field("What the file holds.", alias="schema")
    name: str = field("Name of the map.", pattern=r"^[a-z0-9][a-z0-9._-]{0,99}$")
    title: str = field("One line for people.", default="", max_length=200)
    time: Annotated[ChannelSource, BeforeValidator(_source_of_shorthand)] | None = optional(
        "Where the time comes from; in place of `time` among the channels."
    )
    channels: dict[str, Annotated[ChannelSource, BeforeValidator(_source_of_shorthand)] | None] = field(
        "Canonical channel -> where it comes from; {n} stands for each wheelset's number. null: it is not"
        " read, though the map that is extended has it."
    )
    csv: DialectSection = field("Dialect of text files.", default=DialectSection())
    preparation: Preparation = field("How a record is prepared before it is judged.", default=Preparation())

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield unknown channels, and units of another kind than their channel."""
        if self.time is not None:
            yield from _unit_inconsistencies((TIME,), self.time)
        for name, source in self.channels.items():
            yield from _unit_inconsistencies(("channels", name), source or _NOT_READ)

    @property
    def dialect(self) -> Dialect:
        """The dialect of text files: of ``csv`` all but `dates`, which a channel map alone knows.

        A dialect says how cells are split and numbers written; `dates` is used later, for the time channel.
        """
        return Dialect(**{name: value for name, value in self.csv if name != "dates"})

    @cached_property
    def sources(self) -> Mapping[str, ChannelSource]:
        """The source of every channel, one per wheelset; a channel of one wheelset has precedence."""
        spelled_out: dict[str, ChannelSource | None] = {}
        for name, source in self.channels.items():
            numbers = WHEELSETS if NUMBER in name else ()
            spelled_out |= {
                name.replace(NUMBER, str(n)): source and _source_of_wheelset(source, n) for n in numbers
            }
        spelled_out |= {name: s for name, s in self.channels.items() if NUMBER not in name}
        spelled_out |= {TIME: self.time} if self.time else {}
        return {name: source for name, source in spelled_out.items() if source is not None}

    def triggered_by(self, trigger: str | None) -> ChannelMap:
        """Return the map with another trigger, a name or a time; None: as it says. Raises ValueError."""
        if trigger is None:
            return self
        key = "trigger_time" if any(map(str.isdigit, trigger)) else "trigger"
        stated = {**dict(self.preparation), "trigger_time": None, key: trigger}
        try:
            preparation = Preparation.model_validate(stated)
        except ValidationError as error:
            raise ValueError(f"trigger {trigger!r}: {error.errors(include_url=False)[0]['msg']}") from error
        return self.model_copy(update={"preparation": preparation})


def presets() -> tuple[str, ...]:
    """Return the names of the channel maps that come with the program."""
    return tuple(sorted(path.stem for path in _PRESETS.glob("*.yaml")))


def load_map(reference: str, trusted: Sequence[Path] = ()) -> tuple[ChannelMap, dict[str, str]]:
    """Return the map of a preset or file, and the files that were read for it with their SHA-256.

    Parents stay at or below the folder of the map, the working folder and
    the `trusted` folders. Raises ScenarioErrors with every error at its place, and KeyError for a
    reference that is neither a preset nor a YAML file.
    """
    if reference in presets():
        tree = read_file(_PRESETS / f"{reference}.yaml")
    elif reference.endswith((".yaml", ".yml")):
        tree = read_file(Path(reference))
    else:
        raise KeyError(reference)
    files = Files(Roots.of([Path(reference)], trusted))
    merged, documents = inherit(tree, fetch=lambda parent: _read_parent(parent, files))
    loaded: ChannelMap = validated(ChannelMap, plain(merged), merged)
    inputs = {
        document.display
        if document.folder != _PRESETS
        else f"library:channel_maps/{Path(document.display).name}": document.sha256
        for document in documents
    }
    return loaded, inputs


def _read_parent(reference: Scalar, files: Files) -> Map:
    if reference.text in presets():
        return read_file(_PRESETS / f"{reference.text}.yaml")
    if not is_path(reference.text):
        hint = suggestion(reference.text, presets())
        raise single_error(reference.location, f"no channel map {quoted(reference.text)}", "extends", hint)
    return files.beside(reference, "extends")


def _source_of_wheelset(source: ChannelSource, number: int) -> ChannelSource:
    names: tuple[str, ...] = tuple(name.replace(NUMBER, str(number)) for name in source.source)
    changed: dict[str, Any] = {"source": names}
    return source.model_copy(update=changed)


def channel_map_schema() -> dict[str, Any]:
    """Return the schema of ``uictest/channel-map/1`` as it is written: a channel may be a name or names."""
    schema: dict[str, Any] = schema_of(ChannelMap, "uictest channel-map")
    name = {"type": "string"}
    based_on = {"description": "A preset or a file that this map is based on.", **name}
    schema["properties"] = {**schema["properties"], "extends": based_on}
    schema["required"] = ["schema", "name"]
    names = {"type": "array", "minItems": 1, "items": name}
    for source in (schema["properties"]["time"], schema["properties"]["channels"]["additionalProperties"]):
        source["anyOf"] += [name, names]
    return schema
