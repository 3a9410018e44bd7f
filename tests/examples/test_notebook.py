"""The notebooks: their code runs, and what is stored in them is what it gives."""

import sys
from pathlib import Path

import nbformat
import pytest

REPOSITORY = Path(__file__).parents[2]
NOTEBOOKS = sorted((REPOSITORY / "examples" / "notebook").glob("*.ipynb"))


@pytest.fixture(autouse=True)
def tools_on_path(monkeypatch):
    """The tools of the pages are scripts beside each other."""
    before = set(sys.modules)
    monkeypatch.syspath_prepend(str(REPOSITORY / "docs" / "tools"))
    yield
    for name in {"notebooks", "consoles", "markup"} - before:
        sys.modules.pop(name, None)


def texts(outputs):
    return ["".join(each["text"] if "text" in each else each["data"]["text/plain"]) for each in outputs]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_is_a_valid_notebook_that_names_no_machine_and_stores_what_its_code_gives(path):
    """Up to the digits: figures move with calibration, and docs/tools/notebooks.py renews them."""
    from consoles import shape
    from notebooks import executed

    before = sorted(path.parent.iterdir())
    for cell, outputs in executed(path):
        stored = [shape(text) for text in texts(cell["outputs"])]
        assert stored == [shape(text) for text in texts(outputs)], "run docs/tools/notebooks.py"
    assert sorted(path.parent.iterdir()) == before
    nbformat.validate(nbformat.read(path, as_version=4))
    text = path.read_text("utf-8")
    assert str(REPOSITORY) not in text
    assert str(Path.home()) + "/" not in text
