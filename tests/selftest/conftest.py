"""An installation under examination."""

from __future__ import annotations

import pytest

from uictest import selftest


@pytest.fixture(scope="session")
def stops() -> selftest.KnownStops:
    """The known stops, each simulated once."""
    return selftest.KnownStops()
