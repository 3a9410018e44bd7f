"""The pages and the tools that renew them."""

import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
TOOLS = REPOSITORY / "docs" / "tools"


def pages():
    """Return every Markdown page that the repository shows."""
    return [*sorted(REPOSITORY.glob("*.md")), *sorted((REPOSITORY / "docs").glob("*.md"))]


def pytest_generate_tests(metafunc):
    """A test that asks for a page runs for each of them."""
    if "page" in metafunc.fixturenames:
        metafunc.parametrize("page", pages(), ids=lambda path: path.name)


@pytest.fixture(autouse=True)
def tools_on_path(monkeypatch):
    """The tools are scripts beside each other; they are found as when one of them is run."""
    before = set(sys.modules)
    monkeypatch.syspath_prepend(str(TOOLS))
    yield
    for name in set(sys.modules) - before:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(str(TOOLS)):
            del sys.modules[name]
