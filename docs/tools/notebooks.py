"""Notebooks: the code in them is run, and the outputs stored in them are what it gives.

    python docs/tools/notebooks.py [NOTEBOOK...]

Without notebooks, all of `examples/notebook/`. Texts and tables are stored; figures are not, since they need
the scripts of a viewer.
"""

from __future__ import annotations

import ast
import contextlib
import io
import json
import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

REPOSITORY = Path(__file__).parents[2]
_WIDE = {"display.width": 100, "display.max_columns": 20, "display.max_rows": 60}
Cell = dict[str, Any]


def notebooks() -> list[Path]:
    """Return every notebook of the examples."""
    return sorted((REPOSITORY / "examples" / "notebook").glob("*.ipynb"))


def read(path: Path) -> Cell:
    """Return the document of a notebook."""
    document: Cell = json.loads(path.read_text("utf-8"))
    return document


def executed(path: Path) -> Iterator[tuple[Cell, list[Cell]]]:
    """Yield each code cell with its outputs, run one after the other in the folder of the notebook."""
    import pandas as pd

    names: dict[str, Any] = {"__name__": "__main__"}
    before = Path.cwd()
    os.chdir(path.parent)
    try:
        with pd.option_context(*(word for option in _WIDE.items() for word in option)):
            code = [cell for cell in read(path)["cells"] if cell["cell_type"] == "code"]
            for number, cell in enumerate(code, start=1):
                yield cell, _outputs("".join(cell["source"]), names, number)
    finally:
        os.chdir(before)


def _outputs(source: str, names: dict[str, Any], number: int) -> list[Cell]:
    """Return what a cell prints, and the value of its last line if that is an expression."""
    body = ast.parse(source).body
    last = body.pop() if body and isinstance(body[-1], ast.Expr) else None
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(ast.Module(body, []), f"<cell {number}>", "exec"), names)
        value = None if last is None else eval(compile(ast.Expression(last.value), "<cell>", "eval"), names)
    outputs: list[Cell] = []
    if printed.getvalue():
        outputs.append({"name": "stdout", "output_type": "stream", "text": _lines(printed.getvalue())})
    if value is not None and not hasattr(value, "to_plotly_json"):
        data = {"text/plain": _lines(repr(value))}
        if hasattr(value, "_repr_html_"):
            data = {"text/html": _lines(value._repr_html_()), **data}
        about = {"execution_count": number, "metadata": {}, "output_type": "execute_result"}
        outputs.append({"data": data, **about})
    return outputs


def _lines(text: str) -> list[str]:
    return text.splitlines(keepends=True)


def refresh(path: Path) -> None:
    """Store in a notebook what its code gives now."""
    document = read(path)
    code = iter(executed(path))
    for cell in document["cells"]:
        if cell["cell_type"] == "code":
            _, cell["outputs"] = next(code)
            cell["execution_count"] = None if not cell["outputs"] else _count(cell["outputs"])
    path.write_text(json.dumps(document, indent=1, ensure_ascii=False) + "\n", "utf-8")


def _count(outputs: Sequence[Cell]) -> int | None:
    return next((each["execution_count"] for each in outputs if "execution_count" in each), None)


if __name__ == "__main__":
    for place in [Path(name) for name in sys.argv[1:]] or notebooks():
        refresh(place)
