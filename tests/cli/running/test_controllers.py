"""Two controllers on the same cases: the noise belongs to the case, not to the controller."""

import shutil
from pathlib import Path

import pytest

TWIN = Path(__file__).parents[2] / "sweeps" / "controllers" / "slip_band.py"
"""The built-in slip-band as a controller from outside."""
CASES = "rail: {condition: wet}\nmatrix: {rail.friction: [0.08, 0.10], seed: [1, 2]}\n"
OUTSIDE = "controller={python: slip_band.py, class: SlipBand, parameters: {lower_slide: %s}}"
BUILT_IN = "controller=slip-band"


@pytest.fixture
def run(call, scenario):
    """Run four cases with a controller into a folder."""
    scenario("stop", CASES)
    shutil.copy(TWIN, ".")
    return lambda folder, *options: call(
        "run", "--in-process", "--report", "csv", "-o", folder, "--set", *options
    )


def test_a_controller_named_on_the_command_line_leaves_ids_and_noise(run, call):
    for folder, controller in (("ours", BUILT_IN), ("theirs", OUTSIDE % 0.08)):
        assert run(folder, controller, "--record", "all").code in (0, 1)
    compared = call("compare", "ours/latest", "theirs/latest")
    assert "no difference" in compared.err
    assert compared.code == 0
    names = [folder / "latest/recordings" for folder in (Path("ours"), Path("theirs"))]
    ours, theirs = (sorted(path.name for path in each.glob("*.parquet")) for each in names)
    assert ours == theirs != []
    case = call("compare", names[0] / ours[0], names[1] / ours[0])
    assert "measured_speed" not in case.out


def test_controllers_differ_case_by_case_and_noise_of_another_name(run, call):
    run("ours", BUILT_IN)
    run("both", "controller=slip-band,threshold")
    first, second = (Path(folder, "latest/summary.csv").read_text() for folder in ("ours", "both"))
    distance = first.splitlines()[0].split(",").index("braking_distance_m")
    ours, both = ({line.split(",")[distance] for line in each.splitlines()[1:]} for each in (first, second))
    assert not ours & both
    run("theirs", OUTSIDE % 0.15)
    compared = call("compare", "ours/latest", "theirs/latest", code=1)
    for case in ("0.08,seed=1", "0.08,seed=2", "0.10,seed=1", "0.10,seed=2"):
        assert f"differs  stop[friction={case}]" in compared.out


def test_the_built_in_twin_keeps_a_baseline_and_another_controller_does_not(run):
    run("first", BUILT_IN, "--baseline", "kept", "--accept")
    assert "no difference" in run("second", OUTSIDE % 0.08, "--baseline", "kept").err
    answer = run("third", OUTSIDE % 0.15, "--baseline", "kept")
    assert answer.code == 1
    assert "different from the baseline" in answer.err
