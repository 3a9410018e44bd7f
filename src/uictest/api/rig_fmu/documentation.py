"""What an FMU says about itself: the case, its parameters, versions and the SHA-256 of its files."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from importlib import metadata
from pathlib import Path

from uictest import __version__
from uictest.api.rig_fmu.variables import variables
from uictest.judging import evaluation
from uictest.plans import scenario

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
