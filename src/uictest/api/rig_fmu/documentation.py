"""What an FMU says about itself, and the case as numbers in its generated header."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from importlib import metadata
from pathlib import Path
from typing import Any, Final

import numpy as np

from uictest import __version__
from uictest.api.rig_fmu.variables import INSTANCE_MEMORY, Variable, place_of, variables
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import STEP, STOP_MEMORY, StopInputs

_STYLE = "body{font:15px sans-serif;max-width:60em;margin:2em auto}td,th{text-align:left;padding:0 1em 0 0}"
_PACKAGES = ("numba", "llvmlite", "numpy")


def documentation(case: scenario.Case, parts: dict[str, evaluation.EffectivePart]) -> bytes:
    """Return `documentation/index.html`."""
    return "\n".join(_page(case, parts)).encode()


def provenance(case: scenario.Case, parts: dict[str, evaluation.EffectivePart]) -> bytes:
    """Return `resources/case.json`: the same for programs."""
    content = {
        "uictest": __version__,
        "case": case.id,
        "cycle_time": float(case.scenario.controller.cycle_time),
        "scenario": case.path.name,
        "parameters": dict(case.parameters),
        "inputs": dict(_files(case)),
        "parts": evaluation.parts_document([parts]),
    }
    return json.dumps(content, indent=1, ensure_ascii=False).encode() + b"\n"


def _page(case: scenario.Case, parts: dict[str, evaluation.EffectivePart]) -> Iterator[str]:
    title = escape(f"Brake rig: {case.id}")
    yield f"<!DOCTYPE html><meta charset='utf-8'><title>{title}</title><style>{_STYLE}</style>"
    yield f"<h1>{title}</h1><p>{escape(case.scenario.title)}</p>"
    cycle = case.scenario.controller.cycle_time.text
    yield (
        f"<p>One stop from {escape(case.scenario.initial_speed.text)}, which begins at the brake command. The"
        f" communication step is the controller cycle, {escape(cycle)}; any other is an error. Outputs do not"
        " depend on inputs of the same instant. After the end of the stop the outputs stay.</p>"
    )
    yield "<h2>Variables</h2>"
    rows = ((each.name, each.causality, each.unit, each.description) for each in variables())
    yield from _table(("name", "causality", "unit", "description"), rows)
    yield "<h2>Versions</h2>"
    yield from _table(("program", "version"), [("uictest", __version__), *_versions()])
    yield "<h2>Files</h2>"
    yield from _table(("file", "SHA-256"), _files(case))
    for role, part in parts.items():
        yield f"<h2>{escape(role)}: {escape(part.name)}</h2>"
        yield from _table(("key", "value", "mark"), ((p.key, p.written, p.mark) for p in part.parameters))


def _files(case: scenario.Case) -> Iterator[tuple[str, str]]:
    """Yield the files of a case with their SHA-256; a folder of this machine is nobody else's business."""
    for name, digest in case.inputs.items():
        yield (Path(name).name if Path(name).is_absolute() else name), digest


def _versions() -> Iterator[tuple[str, str]]:
    yield from ((name, metadata.version(name)) for name in _PACKAGES)


def _table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    yield "<table><tr>" + "".join(f"<th>{heading}</th>" for heading in headings) + "</tr>"
    for row in rows:
        yield "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>"
    yield "</table>"


_PLACES: Final = {
    "PARAMETERS_AT": "stop.parameters",
    "STOPPED_AT": "stop.car.stopped",
    "CYCLE_AT": "stop.car.cycle",
    "LONGEST_STOP_AT": "stop.parameters.cycles",
    "COMMANDED_HOLD_AT": "stop.exchange.hold",
    "COMMANDED_VENT_AT": "stop.exchange.vent",
    "TIME_AT": "time",
    "ENDED_AT": "ended",
    "HOLD_AT": "hold",
    "VENT_AT": "vent",
}
"""Name in C -> field of the memory of an instance."""
_STORAGES: Final = {"f8": "FLOAT64", "i4": "INT32", "i8": "INT64"}


def case_header(inputs: StopInputs) -> str:
    """Return `case.h` without the token that ties it to a model description."""
    lines = [
        *_sizes_and_places(),
        f"#define CYCLE_TIME {float(inputs.parameters['cycle_time']).hex()}",
        *_words("PARAMETERS", inputs.parameters),
        *_words("WHEELSET_PARAMETERS", inputs.wheelset_parameters),
        *_words("RAIL", inputs.rail),
        *_call(inputs.rail.shape[1]),
        *_variables(variables()),
    ]
    return "".join(f"{line}\n" for line in lines)


def _sizes_and_places() -> Iterator[str]:
    yield f"#define MEMORY_SIZE {INSTANCE_MEMORY.itemsize}"
    yield f"#define STOP_SIZE {STOP_MEMORY.itemsize}"
    for name, path in _PLACES.items():
        yield f"#define {name} {place_of(path)}"


def _words(name: str, values: Any) -> Iterator[str]:
    """Yield numbers bit by bit: decimal digits could round."""
    words = np.frombuffer(values.tobytes(), "<u8")
    yield f"static const uint64_t {name}[] = {{"
    yield from (f"    {word:#x}," for word in words)
    yield "};"


def _call(points: int) -> Iterator[str]:
    """Yield the call of the machine code, whose arguments are those of :data:`uictest.rig.STEP_ARGUMENTS`."""
    count = len(STOP_MEMORY.names)
    parts = ", ".join(f"(memory) + {STOP_MEMORY.fields[name][1]}" for name in STOP_MEMORY.names)
    pointers = ", ".join(["void *"] * count)
    kinds = f"{pointers}, const void *, const void *, int64_t, void *, void *, int64_t, int64_t, int64_t"
    yield f"int64_t {STEP}({kinds});"
    yield f"#define CARRY_OUT(memory) {STEP}({parts}, \\"
    yield f"    WHEELSET_PARAMETERS, RAIL, {points}, NULL, NULL, 0, 0, 0)"


def _variables(declared: Iterable[Variable]) -> Iterator[str]:
    yield "typedef enum { REAL, BOOLEAN, INTEGER } Kind;"
    yield "typedef enum { INDEPENDENT, INPUT, OUTPUT, PARAMETER } Causality;"
    yield "typedef enum { FLOAT64, INT32, INT64 } Storage;"
    yield "typedef struct { Kind kind; Causality causality; Storage storage; size_t offset; } Variable;"
    yield "static const Variable VARIABLES[] = {"
    for each in declared:
        names = f"{each.kind.upper()}, {each.causality.upper()}, {_STORAGES[each.storage]}"
        yield f"    {{{names}, {each.offset}}}, /* {each.name} */"
    yield "};"
