"""`uictest_run`: the results of scenarios in tests that people write."""

from .conftest import SHORT_STOPS

TEST = """\
def test_distance_falls_with_the_command(uictest_run):
    distance = uictest_run("scenarios/stop.yaml", set={"brake.command": ["80 %", "90 %"]}).frame()[
        "braking_distance_m"
    ]
    assert distance.is_monotonic_decreasing and len(distance) == 2
"""


def test_results_in_a_test(run, write, scenario, monkeypatch):
    write("pytest.ini", "[pytest]\n")
    write("short-stops.yaml", SHORT_STOPS)
    scenario("stop", "criteria: ../short-stops.yaml\n")
    folder = write("tests/test_own.py", TEST).parent
    monkeypatch.chdir(folder)
    assert run().summary == "1 passed"
