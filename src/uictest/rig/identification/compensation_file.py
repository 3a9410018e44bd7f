"""Compensation files: read as the base of an identification, written with the identified numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from uictest.core.units import BAR, KILONEWTON, KILONEWTON_PER_BAR, in_unit
from uictest.plans.scenario import RIG_SOURCE, Compensation, Files, Parts, Roots
from uictest.plans.scenario.yaml import Document, Quantity, Scalar, display_name, parse, whole_file
from uictest.rig.identification.cylinder import AirResult, CylinderResult
from uictest.rig.identification.hysteresis import HysteresisResult, all_four
from uictest.rig.identification.lines import FittedLine


class _Number(NamedTuple):
    """A value as written, and the key of its source."""

    text: str
    source: str


Numbers = dict[str, Any]
"""Nested mapping like the file, of numbers."""

_TOLERANCES_OF = "six-inch"
"""The compensation of the library whose tolerances others take."""
_RIG_DESCRIBED = {"mark": "identified", "text": "The rig of the records, as built"}
_SUBJECTS = ("hysteresis", "cylinder", "air")


@dataclass(frozen=True, slots=True)
class Provenance:
    """Origin of the numbers of an identification, as text.

    Attributes:
        record: name of the recording's file.
        digest: SHA-256 of the file.
        samples_digest: SHA-256 of the samples: :func:`~uictest.rig.identification.samples_digest`.
        origin: what was recorded, as the file states it.
        command: the command line.
        version: of this program.
        date: empty: omitted, so that the same record gives the same file.
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
        part: Compensation = Parts(files).part(files.at(Path(reference)), Compensation, ()).part
        return part
    location = whole_file(Path("--base"))
    named: Compensation = (
        Parts(Files()).part(Scalar(reference, reference, location), Compensation, ("base",)).part
    )
    return named


def check_compensation(text: str, path: Path) -> None:
    """Raise ScenarioErrors if a compensation file of this text would be rejected; ``path`` is its name."""
    tree = parse(Document(display_name(path), path.parent, text))
    Parts(Files()).part(tree, Compensation, ())


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
    numbers = _sourced_parameters(base)
    numbers["linear"] = _line_entry(result.linear, source)
    numbers["hysteresis"] = {
        **{phase: _line_entry(line, source) for phase, line in all_four(result.level_lines).items()},
        "transition_time": _Number(f"{transition * 1e3:.6g} ms", option),
        "wsp_acting_time": _Number(f"{acting_time:.6g} s", option),
    }
    fit = (
        f"force error on held-out parts: largest {100.0 * result.largest_error:.2f} %,"
        f" rms {100.0 * result.rms_error:.2f} % of {result.largest_force / KILONEWTON:.2f} kN"
    )
    sources = {
        source: _source_of_identification("Four-phase hysteresis", provenance, fit),
        option: {
            "mark": "chosen",
            "text": "Options --transition-time and --acting-time of the identification",
        },
    }
    return _file_text(base, name, numbers, sources, provenance, "hysteresis", fit)


def with_cylinder(base: Compensation, name: str, result: CylinderResult, provenance: Provenance) -> str:
    """Return the text of ``base`` with the transfer function of ``result``.

    An equal sampling time keeps its source.
    """
    source = "identified-cylinder"
    model = result.transfer_function
    numbers = _sourced_parameters(base)
    if abs(base.sampling_time - model.sampling_time) > 1e-12:
        numbers["sampling_time"] = _Number(f"{model.sampling_time * 1e3:.9g} ms", source)
    numbers["cylinder"] = {
        "numerator": [_Number(repr(b), source) for b in model.numerator],
        "denominator": [_Number(repr(a), source) for a in model.denominator],
    }
    fit = (
        f"pressure error on held-out parts: largest {100.0 * result.largest_after:.2f} %"
        f" ({100.0 * result.largest_before:.2f} % without) of {result.largest_pressure / BAR:.3f} bar,"
        f" fit {result.fit:.2f} %"
    )
    sources = {source: _source_of_identification("Cylinder dynamics", provenance, fit)}
    return _file_text(base, name, numbers, sources, provenance, "cylinder", fit)


def with_air(base: Compensation, name: str, result: AirResult, provenance: Provenance) -> str:
    """Return the text of ``base`` with the air of ``result``."""
    source = "identified-air"
    numbers = _sourced_parameters(base)
    numbers["air"] = {
        "tank_heat_conductance": _Number(f"{result.tank_heat_conductance:.6g} W/K", source),
        "caliper_heat_conductance": _Number(f"{result.caliper_heat_conductance:.6g} W/K", source),
        "swept_volume": _Number(f"{in_unit(result.swept_volume, 'L'):.6g} L", source),
        "closing_pressure": _Number(f"{result.closing_pressure / BAR:.6g} bar", source),
        "opening_pressure": _Number(f"{result.opening_pressure / BAR:.6g} bar", source),
    }
    fit = (
        f"pressure error on held-out parts: largest {100.0 * result.largest_after:.2f} %"
        f" ({100.0 * result.largest_before:.2f} % without), rms {100.0 * result.rms_after:.2f} %"
        f" of {result.largest_pressure / BAR:.3f} bar"
    )
    sources = {source: _source_of_identification("Air of the caliper's module", provenance, fit)}
    return _file_text(base, name, numbers, sources, provenance, "air", fit)


def _line_entry(line: FittedLine, source: str) -> Numbers:
    return {
        "slope": _Number(f"{line.slope / KILONEWTON_PER_BAR:.6g} kN/bar", source),
        "intercept": _Number(f"{line.intercept:.6g} N", source),
    }


def _sourced_parameters(base: Compensation) -> Numbers:
    return {
        "sampling_time": _with_source(base.sampling_time),
        "linear": _with_sources(base.linear),
        "hysteresis": _with_sources(base.hysteresis),
        "cylinder": {name: [_with_source(value) for value in values] for name, values in base.cylinder},
        "air": _with_sources(base.air),
    }


def is_of_one_rig(facts: Mapping[str, str]) -> bool:
    """Return whether all numbers of a compensation with this provenance were identified on one known rig."""
    digests = {facts.get(f"{subject} rig sha256", "") for subject in _SUBJECTS}
    return len(digests) == 1 and "" not in digests


def _listed_rig(rig: Mapping[str, str], tolerances_of: Compensation) -> Numbers:
    """Return the section `identified_for` of a rig; of its dotted keys the last two elements count."""
    assert tolerances_of.identified_for is not None
    numbers: Numbers = {"caliper": {}, "wsp_valve": {}}
    for key, text in rig.items():
        section, name = key.split(".")[-2:]
        if section == "tank":
            numbers["tank_volume"] = _Number(text, RIG_SOURCE)
        else:
            numbers[section][name] = _Number(text, RIG_SOURCE)
    return {**numbers, "tolerances": _with_sources(tolerances_of.identified_for.tolerances)}


def _with_sources(section: Any) -> Numbers:
    """Return the quantities of a section and of those in it, each with its source."""
    return {
        name: _with_source(value) if isinstance(value, Quantity) else _with_sources(value)
        for name, value in section
    }


def _with_source(quantity: Quantity) -> _Number:
    return _Number(quantity.text, quantity.source)


def _source_of_identification(subject: str, provenance: Provenance, fit: str) -> dict[str, str]:
    text = (
        f"{subject} identified from {provenance.record} ({provenance.origin}; SHA-256 {provenance.digest})"
        f" by `{provenance.command}`; {fit}"
    )
    return {"mark": "identified", "text": text}


def _updated_provenance(subject: str, base: Compensation, provenance: Provenance, fit: str) -> dict[str, str]:
    """Return the provenance of ``base`` with the facts of the identification of one subject replaced."""
    facts = {
        f"{subject} record": provenance.record,
        f"{subject} record sha256": provenance.digest,
        f"{subject} samples sha256": provenance.samples_digest,
        f"{subject} record origin": provenance.origin,
        f"{subject} rig sha256": provenance.rig_digest,
        f"{subject} command": provenance.command,
        f"{subject} version": provenance.version,
        f"{subject} fit": fit,
        f"{subject} date": provenance.date,
    }
    unchanged = {key: fact for key, fact in base.provenance.items() if key not in facts}
    return unchanged | {key: fact for key, fact in facts.items() if fact}


def _file_text(
    base: Compensation,
    name: str,
    numbers: Numbers,
    sources: Mapping[str, Any],
    provenance: Provenance,
    subject: str,
    fit: str,
) -> str:
    facts = _updated_provenance(subject, base, provenance, fit)
    described = {**{key: source.model_dump() for key, source in base.sources.items()}, **sources}
    if is_of_one_rig(facts) and provenance.rig:
        tolerances = load_compensation(_TOLERANCES_OF)
        sources_of_tolerances = {key: source.model_dump() for key, source in tolerances.sources.items()}
        described = {**sources_of_tolerances, **described, RIG_SOURCE: _RIG_DESCRIBED}
        numbers["identified_for"] = _listed_rig(provenance.rig, tolerances)
    used = set(_sources_of(numbers))
    document = {
        "schema": "uictest/compensation/1",
        "name": name,
        "title": base.title if name == base.name else f"Compensation {name}",
        "sources": {key: source for key, source in described.items() if key in used},
        **numbers,
        "provenance": facts,
    }
    heading = (
        "# What stands in for a caliper: equations (4)-(8) of the source, our model of the air; identified.\n"
    )
    return heading + yaml.dump(
        document, Dumper=_Dumper, sort_keys=False, width=118, allow_unicode=True, default_flow_style=False
    )


def _sources_of(numbers: Any) -> Iterator[str]:
    if isinstance(numbers, _Number):
        yield numbers.source
        return
    for inner in numbers if isinstance(numbers, list) else numbers.values():
        yield from _sources_of(inner)


class _Dumper(yaml.SafeDumper):
    """Writes numbers with their source on one line and values of numbers without quotes."""


def _represent_number(dumper: Any, number: _Number) -> Any:
    nodes = [
        (dumper.represent_str("value"), _represent_value(dumper, number.text)),
        (dumper.represent_str("source"), dumper.represent_str(number.source)),
    ]
    return yaml.MappingNode("tag:yaml.org,2002:map", nodes, flow_style=True)


def _represent_value(dumper: Any, text: str) -> Any:
    try:
        float(text)
    except ValueError:
        return dumper.represent_str(text)
    return yaml.ScalarNode("tag:yaml.org,2002:float", text)


_Dumper.add_representer(_Number, _represent_number)
