"""Scenarios that are stepped from outside."""

import pytest


@pytest.fixture
def write_scenario(tmp_path):
    """Write a short stop on a wet rail, with more lines of YAML where a test wants them."""

    def write(extra=""):
        path = tmp_path / "stop.yaml"
        head = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 30 km/h\n"
        path.write_text(f"{head}rail: {{condition: wet, friction: 0.06}}\n{extra}")
        return path

    return write
