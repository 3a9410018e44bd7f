"""An installation under examination."""

import pytest

from uictest import selftest


@pytest.fixture(scope="session")
def stops():
    """The known stops, each simulated once."""
    return selftest.KnownStops()
