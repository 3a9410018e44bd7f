"""What a case was run with: its parts and their changes, car, train; what lies outside of the validated."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cache, partial
from itertools import groupby
from typing import Final

from uictest import controllers
from uictest.core.document import Cell
from uictest.core.units import KINDS, in_unit, value_text
from uictest.judging import evaluation
from uictest.report.verdict_sentences import fault_sentences, is_bypassed
from uictest.report.words import counted, listed, printable

_PATHS: Final = (".yaml", ".yml")
_DIGITS: Final = 12
"""Hexadecimal digits of a SHA-256 in a sentence; the parameters of the part have all of them."""
_MOST_NAMED: Final = 6
"""Deviations of a case that are listed before the rest is counted; chosen."""


def part_sentence(part: evaluation.EffectivePart, setting: str = "", told: str = "") -> str:
    """Return name, setting and changes: `threshold, changed: slip_threshold 3 km/h (library: 1.146 m/s)`.

    A part whose root is not in the library is marked as an own part, because it may have the name of a
    library part; a controller from outside is told by its program, and its parameters follow; `told` is the
    version that it said of itself in a stop. A section of a scenario has no name; its text is empty if it
    changes nothing.
    """
    changes = "; ".join(_changes(part, part.key if part.name else ""))
    texts = (part.name, _own_root(part, told), setting, _given(part), changes and f"changed: {changes}")
    return printable(", ".join(filter(None, texts)))


def part_sentences(parts: Mapping[str, evaluation.EffectivePart], told: str = "") -> dict[str, str]:
    """Return the sentence of each part of a case by role; that of the compensation names its setting, too.

    `told` as for :func:`part_sentence`.
    """
    setting = ""
    if "compensation" in parts:
        rig = {parameter.key: parameter.written for parameter in parts["scenario.rig"].parameters}
        in_use = rig["rig.topology"] != "four-caliper"
        setting = f"setting {rig['rig.compensation']}" if in_use else "not in use with four calipers"
    sentences = {
        role: part_sentence(part, setting if role == "compensation" else "", told)
        for role, part in parts.items()
    }
    return {role: sentence for role, sentence in sentences.items() if sentence}


def changed_parameters(
    parts: Mapping[str, evaluation.EffectivePart], varied: Collection[str] = (), told: str = ""
) -> list[str]:
    """Return the parameters that differ from the library: `controller.slip_threshold 3 km/h (library: ...)`.

    The controller under test comes first, also one of the library that is not the default. Values of the
    scenario itself are compared with its defaults. The keys of `varied` are left out. `told` as for
    :func:`part_sentence`.
    """
    controller_first = sorted(parts.values(), key=lambda part: part.kind != "controller")
    return [printable(change) for part in controller_first for change in _differences(part, varied, told)]


def changes_of(result: evaluation.CaseResult) -> list[str]:
    """Return the parameters of a case that differ from the library, as :func:`changed_parameters` does."""
    return changed_parameters(result.parts, told=result.controller_version)


def changes_line(result: evaluation.CaseResult) -> list[str]:
    """Return one line with the changed parameters of a case, none where nothing differs."""
    changes = "; ".join(changes_of(result))
    return [f"changed parameters: {changes}"] if changes else []


def controller_of(result: evaluation.CaseResult, uictest_version: str = "") -> tuple[str, str]:
    """Return the name of the controller under test and its version; empty what is not known.

    The version of a built-in controller is that of uictest: `uictest 0.2.0`.
    """
    part = result.parts.get("controller")
    if part is None:
        return "", ""
    program = evaluation.program_of(part, result.controller_version)
    if program is None:
        return printable(part.name), f"uictest {uictest_version}" if uictest_version else ""
    return printable(part.name), printable(program.version)


def controllers_text(results: Iterable[evaluation.CaseResult], uictest_version: str = "") -> str:
    """Return the controllers under test, each once: `slip-band (built into uictest 0.2.0)`; empty if unknown.

    One from outside is shown with the contract that it kept: `my-wsp (version 3.1, contract 2)`. One whose
    valves are bypassed in every case is marked so: it was not tested.
    """
    acts: dict[str, bool] = {}
    for result in results:
        name, version = controller_of(result, uictest_version)
        if not name:
            continue
        built_in = evaluation.program_in(result.parts) is None
        text = controller_text(name, version, result.controller_contract, built_in=built_in)
        acts[text] = acts.get(text, False) or not is_bypassed(result.parts)
    # One that told no version in some cases, as they failed, is known by the others.
    known = {text: acts[text] for text in acts if not any(other.startswith(f"{text} (") for other in acts)}
    return ", ".join(text if active else f"{text}, bypassed" for text, active in known.items())


def controller_text(name: str, version: str, contract: int = 0, *, built_in: bool) -> str:
    """Return the name of a controller with its version and the contract that it kept, if known."""
    known = [f"{'built into' if built_in else 'version'} {version}"] if version else []
    known += [f"contract {contract}"] if contract else []
    return f"{name} ({', '.join(known)})" if known else name


def vehicles_text(results: Iterable[evaluation.CaseResult]) -> str:
    """Return the vehicles of some cases, each once; empty where none is known."""
    names = (result.parts["vehicle"].name for result in results if "vehicle" in result.parts)
    return listed(list(dict.fromkeys(names)))


def slide_speed(results: Iterable[evaluation.CaseResult]) -> str:
    """Return the train speed above which the largest slides of some cases count: `10 km/h`.

    Where it is not known, or the cases differ, it is `moving_speed`, as the measures call it.
    """
    known = {
        parameter.written
        for result in results
        if (part := result.parts.get("measures")) is not None
        for parameter in part.parameters
        if parameter.key == "measures.moving_speed"
    }
    return printable(known.pop()) if len(known) == 1 else "moving_speed"


def base_word(part: evaluation.EffectivePart) -> str:
    """Return the name of the values that a part is compared with."""
    if part.based_on is None:
        return "default"
    return part.based_on if part.based_on.endswith(_PATHS) else "library"


def program_sentence(program: evaluation.Program) -> str:
    """Return a controller from outside in words: `version 1.2.0, python my_wsp.py, SHA-256 8ef1fb87eb73`."""
    told = program.told_version and f" (the program says {program.told_version})"
    version = program.version and f"version {program.version}{told}"
    digest = program.sha256 and f"SHA-256 {program.sha256[:_DIGITS]}"
    return ", ".join(filter(None, (version, f"{program.kind} {program.source}", digest)))


def _own_root(part: evaluation.EffectivePart, told: str) -> str:
    """Return that a part is the user's own, and its root file or program; empty for a library part."""
    if not part.name or base_word(part) == "library":
        return ""
    if (program := evaluation.program_of(part, told)) is not None:
        return program_sentence(program)
    return f"own part based on {part.based_on}" if part.based_on else "own part"


def _given(part: evaluation.EffectivePart, varied: Collection[str] = ()) -> str:
    """Return the parameters that a controller from outside is given, except changed and varied ones."""
    if evaluation.program_of(part) is None:
        return ""
    above = f"{part.key}.parameters."
    given = [
        f"{parameter.key.removeprefix(above)} {parameter.written}"
        for parameter in part.parameters
        if parameter.key.startswith(above) and not parameter.differs and parameter.key not in varied
    ]
    return f"with {'; '.join(given)}" if given else ""


def _differences(part: evaluation.EffectivePart, varied: Collection[str], told: str) -> Iterator[str]:
    # A profile has no key; every verdict shows its limits.
    if part.key and part.key not in varied and (root := _own_root(part, told)):
        yield f"{part.key} {part.name} ({', '.join(filter(None, (root, _given(part, varied))))})"
    elif part.kind == "controller" and part.key not in varied and part.based_on != controllers.DEFAULT:
        yield f"{part.key} {part.name} (default: {controllers.DEFAULT})"
    yield from _changes(part, "", varied)


def _changes(part: evaluation.EffectivePart, above: str, varied: Collection[str] = ()) -> Iterator[str]:
    yield from fault_sentences(part.changed, varied)
    changed = [
        parameter
        for parameter in part.changed
        if parameter.key not in varied and not parameter.key.startswith("faults.")
    ]
    for section, parameters in groupby(changed, partial(_added_section, part.kind)):
        if section:
            # As its file writes it, without what it leaves at a default.
            first = len(section) + 1
            stated = [
                (parameter.key[first:].split("."), parameter.written)
                for parameter in parameters
                if parameter.mark != "default"
            ]
            if stated:
                yield f"{section} {_as_yaml(stated)}"
            continue
        for parameter in parameters:
            key = parameter.key.removeprefix(f"{above}.")
            yield f"{key} {parameter.written} ({base_word(part)}: {parameter.library_written or 'none'})"
    for key in part.removed:
        yield f"{key.removeprefix(f'{above}.')} removed"


def _added_section(kind: str, parameter: evaluation.Parameter) -> str:
    """Return the key of the section or list of a scenario that a parameter was added with; else empty."""
    depth = 1 + kind.count(".")
    names = parameter.key.split(".")
    is_added = kind.startswith("scenario") and not parameter.library_written and len(names) > depth
    return ".".join(names[:depth]) if is_added else ""


def _as_yaml(entries: Sequence[tuple[Sequence[str], str]]) -> str:
    """Return values below their keys in the flow style of YAML: `{force: 40 kN, wheelsets: [1, 2]}`."""
    if not entries[0][0]:
        return entries[0][1]
    inner = {
        name: _as_yaml([(key[1:], text) for key, text in below])
        for name, below in groupby(entries, lambda entry: entry[0][0])
    }
    if all(name.isdigit() for name in inner):
        return f"[{', '.join(inner.values())}]"
    return f"{{{', '.join(f'{name}: {text}' for name, text in inner.items())}}}"


def domain_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield the conditions of a case outside of what was validated; nothing where all lie inside."""
    domain = result.domain_of_validity
    if domain is None or not domain.outside:
        return
    shown = list(map(deviation_text, domain.outside[:_MOST_NAMED]))
    more = len(domain.outside) - len(shown)
    rest = f"; {more} more in results.json" if more else ""
    yield printable(f"outside of what {domain.validation} validated: {'; '.join(shown)}{rest}")


def notices(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield how many cases lie outside of what each validation saw, and which requirements records lack."""
    domains: dict[str, list[bool]] = {}
    for result in results:
        if (domain := result.domain_of_validity) is not None:
            domains.setdefault(domain.validation, []).append(bool(domain.outside))
    for name, outside in domains.items():
        among = counted(len(outside), "case")
        yield printable(f"{sum(outside)} of {among} outside of what {name} validated")
    verdicts = (verdict for result in results for verdict in result.criteria)
    lacking = Counter((verdict.id, verdict.reason) for verdict in verdicts if verdict.lacks_channel)
    for (criterion, reason), count in lacking.items():
        yield printable(f"{counted(count, 'stop')} judged without {criterion}, {reason}")


def deviation_text(deviation: evaluation.Deviation) -> str:
    """Return one condition in the units of engineers, e.g. `initial_speed 160 km/h > 120 km/h`."""
    found, validated = deviation.found, deviation.validated
    if isinstance(found, tuple) and isinstance(validated, tuple):
        return f"{deviation.key} {_beyond(found, validated, deviation.unit)}"
    return f"{deviation.key} {_text(found, deviation.unit)}, validated {_text(validated, deviation.unit)}"


def interval_text(lowest: float, highest: float, unit: str) -> str:
    """Return an interval of SI values in the units of engineers; one value where both ends are the same."""
    low, high = _value(lowest, unit), _value(highest, unit)
    return high if low == high else f"{low.removesuffix(f' {_usual(unit)}')} .. {high}"


def _beyond(found: tuple[float, float], validated: tuple[float, float], unit: str) -> str:
    above, below = found[1] > validated[1], found[0] < validated[0]
    if above and below:
        return f"{interval_text(*found, unit)}, validated {interval_text(*validated, unit)}"
    end, sign, bound = (found[1], ">", validated[1]) if above else (found[0], "<", validated[0])
    return f"{_value(end, unit)} {sign} {_value(bound, unit)}"


def _text(value: str | tuple[float, float] | None, unit: str) -> str:
    if value is None:
        return "not set"
    return value if isinstance(value, str) else interval_text(*value, unit)


def _value(value: float, unit: str) -> str:
    if unit in ("", "1"):
        return f"{value:.4g}"
    return value_text(in_unit(value, _usual(unit)), _usual(unit))


@cache
def _usual(si: str) -> str:
    """Return the unit that engineers use for an SI unit."""
    kinds = (kind for kind in KINDS.values() if kind.canonical == si and kind.units)
    return next((next(iter(kind.units)) for kind in kinds), si)


def car_facts(result: evaluation.CaseResult) -> dict[str, str]:
    """Return the figures of the car by their names; none of a recorded stop."""
    if (car := result.car) is None:
        return {}
    masses = {"car mass": f"{car.mass_t:.4g} t", "axle load": f"{car.axle_load_t:.4g} t"}
    return masses | {"braked weight percentage": f"{car.braked_weight_percentage:.0f} %"}


def implausible_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield the implausible properties of the car, each with the likely mistake."""
    for figure in () if result.car is None else result.car.implausible:
        yield printable(f"implausible: {figure}: {figure.likely}")


TRAIN_COLUMNS: Final = (
    *("train", "cars"),
    *(f"coupler_{side}_{what}_n" for side in ("ahead", "behind") for what in ("pull", "push")),
)
"""Columns of tables with cars of trains: the largest force of each kind in the coupler on each side."""


def train_cells(result: evaluation.CaseResult) -> dict[str, Cell]:
    """Return the cells of `TRAIN_COLUMNS`; none for a car alone."""
    if result.train is None:
        return {}
    cells: dict[str, Cell] = {"train": result.train.train, "cars": result.train.cars}
    for side, forces in result.train.couplers:
        cells[f"coupler_{side}_pull_n"] = forces.largest_pull_n
        cells[f"coupler_{side}_push_n"] = forces.largest_push_n
    return cells


def train_facts(result: evaluation.CaseResult) -> Iterator[tuple[str, str]]:
    """Yield where a car runs and the largest forces in its couplers, each with its name."""
    if result.train is None:
        return
    yield "place", f"{result.train.label} of {result.train.train}"
    for side, forces in result.train.couplers:
        yield f"coupler {side}", f"largest {forces}"


def train_text(result: evaluation.CaseResult) -> str:
    """Return the place of a car and its coupler forces in one line; empty for a car alone."""
    if result.train is None:
        return ""
    couplers = (f"coupler {side}: {forces}" for side, forces in result.train.couplers)
    return "; ".join([result.train.label, *couplers])
