"""The PI controller of examples/pi: what its page claims, on rails that it was not tuned on."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from uictest import rig
from uictest.cli.entry import execute
from uictest.plans.scenario import load
from uictest.plans.scenario.yaml import plain, read_file
from uictest.plans.sweeps import load_sweep

REPOSITORY = Path(__file__).parents[2]
PI = REPOSITORY / "examples" / "pi"
TUNED_ON, JUDGED_ON = "tuning.sweep.yaml", "judging.yaml"
FRICTION, SEED = "rail.friction", "seed"


def stop(*overrides):
    """The stop of one case from 120 km/h."""
    [case] = load([PI / "slippery-120.yaml"], overrides)
    return rig.simulate(case, run=rig.run_in_process)


@pytest.mark.parametrize("friction", [0.09, 0.11])
def test_it_slides_less_and_stops_shorter_than_the_built_in_controller(friction):
    ours, built_in = (
        stop(f"rail.friction={friction}", *controller) for controller in ((), ("controller=threshold",))
    )
    assert ours.measures.braking_distance < built_in.measures.braking_distance
    assert ours.wheelset_measures.longest_lock.max() == 0.0
    assert ours.wheelset_measures.maximum_slide.max() < built_in.wheelset_measures.maximum_slide.max()


def test_it_leaves_the_brake_alone_on_a_good_rail():
    dry = "rail.condition=dry", "rail.friction=null"
    ours, bypassed = stop(*dry), stop(*dry, "rig.wsp=bypassed")
    assert ours.wheelset_measures.valve_actuations.tolist() == [0, 0, 0, 0]
    assert ours.measures.braking_distance == bypassed.measures.braking_distance


def test_it_is_judged_where_it_was_not_tuned():
    plan = load_sweep(PI / TUNED_ON)
    tuned = {key: {value.text for value in plan.listed()[key]} for key in (FRICTION, SEED)}
    cases = load([PI / JUDGED_ON])
    judged = {key: {case.parameters[key] for case in cases} for key in (FRICTION, SEED)}
    assert len(judged[FRICTION]) == 5
    assert len(judged[SEED]) >= 5
    assert not tuned[FRICTION] & judged[FRICTION]
    assert not tuned[SEED] & judged[SEED]
    swept = {key.rpartition(".")[2] for key in plan.keys if key.startswith("controller.parameters.")}
    assert swept == set(plain(read_file(PI / "pi.yaml"))["parameters"])


@pytest.fixture
def copied(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(PI, tmp_path / "pi")
    return tmp_path / "pi"


def printed(script, *arguments):
    command = [sys.executable, script, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()


def test_the_table_has_both_controllers_on_every_rail(copied):
    few = ["-k", "seed=11 and (friction=0.13 or friction=0.15)", "-q", "--report", "csv"]
    for name, controller in (("threshold", "threshold"), ("pi", "pi/pi.yaml")):
        chosen = ["--set", f"controller={controller}", "-o", name]
        execute(["run", "pi/judging.yaml", *chosen, "--in-process", *few])
    lines = printed(copied / "table.py", "threshold/latest", "pi/latest")
    assert [line.split(" | ")[:2] for line in lines[2:]] == [
        [f"| {friction}", name] for friction in ("0.13", "0.15") for name in ("threshold", "pi")
    ]
    assert [line.split(" | ")[3] for line in lines[2::2]] == ["+0.0 %"] * 2
    assert all(line.endswith("0 of 1 |") for line in lines[2:])


def test_the_best_draws_meet_all_criteria_and_its_files_are_valid(copied):
    columns = "parameters.rail.friction,parameters.controller.parameters.kp,met,braking_distance_m"
    rows = [(0.06, 1, "true", 900), (0.1, 1, "true", 700), (0.06, 2, "true", 800), (0.1, 2, "false", 500)]
    rows += [(0.06, 3, "true", 850), (0.1, 3, "true", 650)]
    Path("summary.csv").write_text("\n".join([columns, *(",".join(map(str, row)) for row in rows)]))
    lines = printed(copied / "best.py", "summary.csv")
    assert lines[0].startswith("2 of 3 draws meet all criteria")
    expected = np.mean([850 / 850, 650 / 650])
    assert lines[1:] == [f"{expected:.3f}  kp: 3", f"{np.mean([900 / 850, 700 / 650]):.3f}  kp: 1"]
    assert execute(["check", "pi"]) == 0
