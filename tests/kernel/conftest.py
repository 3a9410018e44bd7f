"""The generator for tests, which is no part of the package."""

import pytest

from ..conftest import fma_as_written


@pytest.fixture(autouse=True, scope="session")
def _as_written():
    """The generator reads the source of a function, which must be what it runs."""
    with fma_as_written():
        yield
