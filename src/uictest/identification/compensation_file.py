"""Compensation files with identified numbers and where they come from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from uictest.identification.hysteresis import PHASES
from uictest.scenario.quantities import Quantity

if TYPE_CHECKING:
    from uictest.identification.cylinder import CylinderResult
    from uictest.identification.hysteresis import HysteresisResult
    from uictest.identification.lines import Line
    from uictest.scenario.parts.compensation import Compensation

Numbers = dict[str, Any]
"""Nested mapping like the file; a number is a pair of its text and the key of its source."""


@dataclass(frozen=True, slots=True)
class Provenance:
    """What an identification rests on, as text.

    Attributes:
        record: name of the recording.
        digest: SHA-256 of the samples that were used.
        command: the command line.
        version: of this program.
        date: when, as given; empty: not told, so that the same record gives the same file.
    """

    record: str
    digest: str
    command: str
    version: str
    date: str = ""


def with_hysteresis(
    base: Compensation,
    result: HysteresisResult,
    provenance: Provenance,
    acting_time: float,
    transition: float,
) -> str:
    """The text of ``base`` with the lines of ``result``; phases not found get the BC lines."""
    source = "identified-hysteresis"
    numbers = _numbers(base)
    numbers["linear"] = _line(result.linear, source)
    lines = {phase: result.lines.get(phase, result.lines[phase.replace("wsp", "bc")]) for phase in PHASES}
    numbers["hysteresis"] = {
        **{phase: _line(line, source) for phase, line in lines.items()},
        "transition_time": (f"{transition * 1e3:.6g} ms", source),
        "wsp_acting_time": (f"{acting_time:.6g} s", source),
    }
    return _text(base, numbers, source, "Four-phase hysteresis", "hysteresis", provenance)


def with_cylinder(base: Compensation, result: CylinderResult, provenance: Provenance) -> str:
    """The text of ``base`` with the transfer function of ``result``; equal sampling times keep the source."""
    source = "identified-cylinder"
    model = result.transfer_function
    numbers = _numbers(base)
    if abs(base.sampling_time - model.sampling_time) > 1e-12:
        numbers["sampling_time"] = (f"{model.sampling_time * 1e3:.9g} ms", source)
    numbers["cylinder"] = {
        "numerator": [(repr(b), source) for b in model.numerator],
        "denominator": [(repr(a), source) for a in model.denominator],
    }
    return _text(base, numbers, source, "Cylinder dynamics", "cylinder", provenance)


def _line(line: Line, source: str) -> Numbers:
    return {
        "slope": (f"{line.slope * 100.0:.6g} kN/bar", source),
        "intercept": (f"{line.intercept:.6g} N", source),
    }


def _numbers(base: Compensation) -> Numbers:
    return {
        "sampling_time": _pair(base.sampling_time),
        "linear": _pairs(base.linear),
        "hysteresis": {
            name: _pair(value) if isinstance(value, Quantity) else _pairs(value)
            for name, value in base.hysteresis
        },
        "cylinder": {name: [_pair(value) for value in values] for name, values in base.cylinder},
    }


def _pairs(section: Any) -> Numbers:
    return {name: _pair(value) for name, value in section}


def _pair(quantity: Quantity) -> tuple[str, str]:
    return quantity.text, quantity.source


def _text(
    base: Compensation, numbers: Numbers, source: str, subject: str, topic: str, provenance: Provenance
) -> str:
    """The file as YAML."""
    import yaml

    sources = {
        **{key: each.model_dump() for key, each in base.sources.items()},
        source: {
            "mark": "chosen",
            "text": f"{subject} identified from {provenance.record}, a record of the simulated caliper;"
            " the command is under provenance",
        },
    }
    told = {**base.provenance, **dict(_told(topic, provenance))}
    told.pop("state", None)
    used = set(_sources_of(numbers))
    document = {
        "schema": "uictest/compensation/1",
        "name": base.name,
        "title": base.title,
        "sources": {key: each for key, each in sources.items() if key in used},
        **_marked(numbers),
        "provenance": told,
    }
    heading = (
        "# What stands in for a caliper: equations (4)-(7) and (8) of the source, with identified numbers.\n"
    )
    return heading + yaml.dump(
        document, Dumper=_dumper(), sort_keys=False, width=118, allow_unicode=True, default_flow_style=False
    )


def _told(topic: str, provenance: Provenance) -> Iterator[tuple[str, str]]:
    yield f"{topic} record", provenance.record
    yield f"{topic} record sha256", provenance.digest
    yield f"{topic} command", provenance.command
    yield f"{topic} version", provenance.version
    if provenance.date:
        yield f"{topic} date", provenance.date


def _marked(numbers: Any) -> Any:
    if isinstance(numbers, tuple):
        return _Number(value=numbers[0], source=numbers[1])
    if isinstance(numbers, list):
        return [_marked(each) for each in numbers]
    return {key: _marked(each) for key, each in numbers.items()}


def _sources_of(numbers: Any) -> Iterator[str]:
    if isinstance(numbers, tuple):
        yield numbers[1]
        return
    for each in numbers if isinstance(numbers, list) else numbers.values():
        yield from _sources_of(each)


class _Number(dict[str, str]):
    """A value with its source, written on one line."""


def _dumper() -> Any:
    import yaml

    class Dumper(yaml.SafeDumper):
        """Writes numbers with their source in one line and values of numbers without quotes."""

    def write(dumper: Any, number: Mapping[str, str]) -> Any:
        nodes = [
            (dumper.represent_str("value"), _plain(dumper, number["value"])),
            (dumper.represent_str("source"), dumper.represent_str(number["source"])),
        ]
        return yaml.MappingNode("tag:yaml.org,2002:map", nodes, flow_style=True)

    def _plain(dumper: Any, text: str) -> Any:
        try:
            float(text)
        except ValueError:
            return dumper.represent_str(text)
        return yaml.ScalarNode("tag:yaml.org,2002:float", text)

    Dumper.add_representer(_Number, write)
    return Dumper
