"""Searches in folders of their own."""

import pytest

from uictest import runs, searching
from uictest.plans.search import Space, load_search

OFFSET = """
schema: uictest/scenario/1
name: offset
extends: slip-120
search:
  criteria: [locked-wheels]
  ranges: {rail.friction: [0.06, 0.16], initial_speed: [100 km/h, 140 km/h]}
  faults: {kinds: [speed-sensor-offset], from: [0 s, 5 s]}
  fails_in: 3 of 4
  stops: 200
  seed: 1
"""
"""The shipped controller under a speed sensor that reads too much or too little: it locks wheels."""
SOUND = """
schema: uictest/scenario/1
name: sound
extends: slip-120
search:
  criteria: [locked-wheels]
  ranges: {rail.friction: [0.08, 0.20]}
  fails_in: 2 of 3
  stops: 48
"""
"""The shipped controller on wet rails: it locks no wheel."""


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Return a function that writes a scenario into the working folder, and returns its path."""
    monkeypatch.chdir(tmp_path)

    def write_scenario(text, name="search.yaml"):
        path = tmp_path / name
        path.write_text(text, "utf-8")
        return path

    return write_scenario


@pytest.fixture
def search(tmp_path):
    """Return a function that searches a scenario or a space; `folder` is that of the files."""

    def run(path, folder=None, progress=lambda stops, margin: None, **options):
        target = None if folder is None else tmp_path / folder
        space = path if isinstance(path, Space) else load_search(path)
        request = searching.SearchRequest(space, target, **options)
        return searching.run_search(request, progress, runs.Observer())

    return run
