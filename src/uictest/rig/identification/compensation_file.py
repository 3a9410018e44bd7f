"""Compensation files: read as the base of an identification, written with the identified numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

import yaml

from uictest.core.units import BAR, KILONEWTON, KILONEWTON_PER_BAR, in_unit
from uictest.plans.scenario import RIG_SOURCE, Compensation, Files, Parts, Roots
from uictest.plans.scenario.yaml import Document, Quantity, Scalar, display_name, parse, whole_file
from uictest.rig.identification.cylinder import CylinderResult
from uictest.rig.identification.hysteresis import HysteresisResult, all_four
from uictest.rig.identification.lines import FittedLine
from uictest.rig.identification.result_text import (
    RIG_DESCRIBED,
    TOLERANCES_OF,
    AirResult,
    Numbers,
    is_of_one_rig,
    listed_rig,
    with_source,
    with_sources,
)

_FACTS = (
    *("record", "record sha256", "samples sha256", "record origin", "rig sha256"),
    *("command", "version", "fit", "date"),
)
"""Facts of one identification, in the order of `_provenance`."""


@dataclass(frozen=True, slots=True)
class Provenance:
    """Where the numbers of an identification come from, as text.

    Attributes:
        record: name of the recording's file.
        digest: SHA-256 of the file.
        samples_digest: SHA-256 of the samples: :func:`~uictest.rig.identification.samples_digest`.
        origin: what was recorded, as the file states it.
        command: the command line.
        version: of this program.
        date: as stated by the user; empty: omitted, so that the same record gives the same file.
        rig: the rig of the record as built, key of a scenario -> value as written; empty: not known.
    """

    record: str
    digest: str
    samples_digest: str
    origin: str
    command: str
    version: str
    date: str = ""
    rig: Mapping[str, str] = field(default_factory=dict)

    @property
    def rig_digest(self) -> str:
        """SHA-256 of the rig; empty where it is not known."""
        return sha256(repr(sorted(self.rig.items())).encode()).hexdigest() if self.rig else ""


def load_compensation(reference: str, trusted: Sequence[Path] = ()) -> Compensation:
    """Return the compensation of a library name or of a .yaml file.

    References stay at or below the file's folder, the working folder and the ``trusted`` folders. Raises
    ScenarioErrors.
    """
    if reference.endswith((".yaml", ".yml")):
        files = Files(Roots.of([Path(reference)], trusted))
        part: Compensation = Parts(files).resolve(files.at(Path(reference)), Compensation, ()).part
        return part
    place = whole_file(Path("--base"))
    named: Compensation = (
        Parts(Files()).resolve(Scalar(reference, reference, place), Compensation, ("base",)).part
    )
    return named


def check_compensation(text: str, path: Path) -> None:
    """Raise ScenarioErrors if a compensation file of this text would be rejected; ``path`` is its name."""
    tree = parse(Document(display_name(path), path.parent, text))
    Parts(Files()).resolve(tree, Compensation, ())


def with_hysteresis(
    base: Compensation,
    name: str,
    result: HysteresisResult,
    provenance: Provenance,
    acting_time: float,
    transition: float,
) -> str:
    """Return the text of ``base`` with the level lines of ``result``; WSP phases without get the BC line."""
    source, option = "identified-hysteresis", "hysteresis-option"
    numbers = _numbers(base)
    numbers["linear"] = _line(result.linear, source)
    numbers["hysteresis"] = {
        **{phase: _line(line, source) for phase, line in all_four(result.level_lines).items()},
        "transition_time": (f"{transition * 1e3:.6g} ms", option),
        "wsp_acting_time": (f"{acting_time:.6g} s", option),
    }
    fit = (
        f"force error on held-out parts: largest {100.0 * result.largest_error:.2f} %,"
        f" rms {100.0 * result.rms_error:.2f} % of {result.largest_force / KILONEWTON:.2f} kN"
    )
    sources = {
        source: _identified("Four-phase hysteresis", provenance, fit),
        option: {
            "mark": "chosen",
            "text": "Options --transition-time and --acting-time of the identification",
        },
    }
    return _text(base, name, numbers, sources, provenance, _provenance("hysteresis", base, provenance, fit))


def with_cylinder(base: Compensation, name: str, result: CylinderResult, provenance: Provenance) -> str:
    """Return the text of ``base`` with the transfer function of ``result``.

    An equal sampling time keeps its source.
    """
    source = "identified-cylinder"
    model = result.transfer_function
    numbers = _numbers(base)
    if abs(base.sampling_time - model.sampling_time) > 1e-12:
        numbers["sampling_time"] = (f"{model.sampling_time * 1e3:.9g} ms", source)
    numbers["cylinder"] = {
        "numerator": [(repr(b), source) for b in model.numerator],
        "denominator": [(repr(a), source) for a in model.denominator],
    }
    fit = (
        f"pressure error on held-out parts: largest {100.0 * result.largest_after:.2f} %"
        f" ({100.0 * result.largest_before:.2f} % without) of {result.largest_pressure / BAR:.3f} bar,"
        f" fit {result.fit:.2f} %"
    )
    sources = {source: _identified("Cylinder dynamics", provenance, fit)}
    return _text(base, name, numbers, sources, provenance, _provenance("cylinder", base, provenance, fit))


def with_air(base: Compensation, name: str, result: AirResult, provenance: Provenance) -> str:
    """Return the text of ``base`` with the air of ``result``."""
    source = "identified-air"
    numbers = _numbers(base)
    numbers["air"] = {
        "tank_heat_conductance": (f"{result.tank_heat_conductance:.6g} W/K", source),
        "caliper_heat_conductance": (f"{result.caliper_heat_conductance:.6g} W/K", source),
        "swept_volume": (f"{in_unit(result.swept_volume, 'L'):.6g} L", source),
        "closing_pressure": (f"{result.closing_pressure / BAR:.6g} bar", source),
        "opening_pressure": (f"{result.opening_pressure / BAR:.6g} bar", source),
    }
    fit = (
        f"pressure error on held-out parts: largest {100.0 * result.largest_after:.2f} %"
        f" ({100.0 * result.largest_before:.2f} % without), rms {100.0 * result.rms_after:.2f} %"
        f" of {result.largest_pressure / BAR:.3f} bar"
    )
    sources = {source: _identified("Air of the caliper's module", provenance, fit)}
    return _text(base, name, numbers, sources, provenance, _provenance("air", base, provenance, fit))


def _line(line: FittedLine, source: str) -> Numbers:
    return {
        "slope": (f"{line.slope / KILONEWTON_PER_BAR:.6g} kN/bar", source),
        "intercept": (f"{line.intercept:.6g} N", source),
    }


def _numbers(base: Compensation) -> Numbers:
    return {
        "sampling_time": with_source(base.sampling_time),
        "linear": with_sources(base.linear),
        "hysteresis": {
            name: with_source(value) if isinstance(value, Quantity) else with_sources(value)
            for name, value in base.hysteresis
        },
        "cylinder": {name: [with_source(value) for value in values] for name, values in base.cylinder},
        "air": with_sources(base.air),
    }


def _identified(subject: str, provenance: Provenance, fit: str) -> dict[str, str]:
    """The source of identified numbers."""
    text = (
        f"{subject} identified from {provenance.record} ({provenance.origin}; SHA-256 {provenance.digest})"
        f" by `{provenance.command}`; {fit}"
    )
    return {"mark": "identified", "text": text}


def _provenance(subject: str, base: Compensation, provenance: Provenance, fit: str) -> dict[str, str]:
    """Return the provenance of ``base`` with the facts of the identification of one subject replaced."""
    keys = [f"{subject} {fact}" for fact in _FACTS]
    facts = (
        provenance.record,
        provenance.digest,
        provenance.samples_digest,
        provenance.origin,
        provenance.rig_digest,
        provenance.command,
        provenance.version,
        fit,
        provenance.date,
    )
    unchanged = {key: fact for key, fact in base.provenance.items() if key not in keys}
    return unchanged | {key: fact for key, fact in zip(keys, facts, strict=True) if fact}


def _text(
    base: Compensation,
    name: str,
    numbers: Numbers,
    sources: Mapping[str, Any],
    provenance: Provenance,
    facts: Mapping[str, str],
) -> str:
    """The file as YAML."""
    described = {**{key: source.model_dump() for key, source in base.sources.items()}, **sources}
    if is_of_one_rig(facts) and provenance.rig:
        tolerances = load_compensation(TOLERANCES_OF)
        others = {key: source.model_dump() for key, source in tolerances.sources.items()}
        described = {**others, **described, RIG_SOURCE: RIG_DESCRIBED}
        numbers["identified_for"] = listed_rig(provenance.rig, tolerances)
    used = set(_sources_of(numbers))
    document = {
        "schema": "uictest/compensation/1",
        "name": name,
        "title": base.title if name == base.name else f"Compensation {name}",
        "sources": {key: source for key, source in described.items() if key in used},
        **_marked(numbers),
        "provenance": dict(facts),
    }
    heading = (
        "# What stands in for a caliper: equations (4)-(8) of the source, our model of the air; identified.\n"
    )
    return heading + yaml.dump(
        document, Dumper=_Dumper, sort_keys=False, width=118, allow_unicode=True, default_flow_style=False
    )


def _marked(numbers: Any) -> Any:
    if isinstance(numbers, tuple):
        return _Number(value=numbers[0], source=numbers[1])
    if isinstance(numbers, list):
        return [_marked(inner) for inner in numbers]
    return {key: _marked(inner) for key, inner in numbers.items()}


def _sources_of(numbers: Any) -> Iterator[str]:
    if isinstance(numbers, tuple):
        yield numbers[1]
        return
    for inner in numbers if isinstance(numbers, list) else numbers.values():
        yield from _sources_of(inner)


class _Number(dict[str, str]):
    """A value with its source, written on one line."""


class _Dumper(yaml.SafeDumper):
    """Writes numbers with their source on one line and values of numbers without quotes."""


def _represent_number(dumper: Any, number: Mapping[str, str]) -> Any:
    nodes = [
        (dumper.represent_str("value"), _represent_value(dumper, number["value"])),
        (dumper.represent_str("source"), dumper.represent_str(number["source"])),
    ]
    return yaml.MappingNode("tag:yaml.org,2002:map", nodes, flow_style=True)


def _represent_value(dumper: Any, text: str) -> Any:
    try:
        float(text)
    except ValueError:
        return dumper.represent_str(text)
    return yaml.ScalarNode("tag:yaml.org,2002:float", text)


_Dumper.add_representer(_Number, _represent_number)
