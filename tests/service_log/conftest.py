"""MDF and TDMS logs are read in this process, except where a process of its own is the point."""

import warnings

import pytest

from uictest.core.recording.formats import isolation

from ..conftest import READ_APART, read_here


def _read_here(name, path, request, seconds=0.0):
    if "dialect" in request:
        yield from read_here(name, path, request, seconds)
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pieces = list(isolation.pieces_of(name, path, request))
    yield from pieces


@pytest.fixture(autouse=True)
def _pieces_here(monkeypatch):
    monkeypatch.setattr(isolation, "read_apart", _read_here)


@pytest.fixture
def apart(monkeypatch, _pieces_here):
    """Have a process of its own read MDF and TDMS, as users do."""
    monkeypatch.setattr(isolation, "read_apart", READ_APART)
