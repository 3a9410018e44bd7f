"""The compiled stop without its compiler: kept as machine code, refusing what it was not compiled for."""

import os
import platform
import subprocess
import sys

import numpy as np
import pytest

from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.plans.scenario import load
from uictest.rig import simulate
from uictest.rig.backends.machine_code import is_kept
from uictest.rig.backends.scalar import RUN, compiled_stop
from uictest.rig.model.rail import RAIL_MEMORY
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.rig.single_stop import empty_trace

WITHOUT_COMPILER = """
import sys
sys.modules["numba"] = None
from pathlib import Path
from uictest.rig import simulate
from uictest.plans.scenario import load
print(float(simulate(load([Path(sys.argv[1])])[0]).measures.stopped))
"""
ON_AN_OLD_PROCESSOR = """
import sys
from pathlib import Path
from llvmlite import binding
class Features(dict):
    flatten = str
binding.get_host_cpu_name = lambda: "x86-64"
binding.get_host_cpu_features = lambda: Features(fma=False)
from uictest.rig import simulate
from uictest.plans.scenario import load
print(simulate(load([Path(sys.argv[1])])[0]).measures.tobytes().hex())
"""


def arguments(rig):
    inputs = rig.inputs(cycles=1)
    return {
        "car": np.zeros(1, CAR)[0],
        "bogies": np.zeros(2, BOGIE),
        "wheelsets": np.zeros(4, WHEELSET),
        "p": inputs.parameters,
        "wheelset_parameters": inputs.wheelset_parameters,
        "rail": inputs.rail,
        "memory": np.zeros(1, RAIL_MEMORY)[0],
        "measures": np.zeros(1, STOP_MEASURES)[0],
        "wheelset_measures": np.zeros(4, WHEELSET_MEASURES),
        "trace": empty_trace(0),
        "steps_per_sample": 0,
    }


def test_a_warm_start_needs_no_compiler(tmp_path):
    compiled_stop()
    assert is_kept(RUN)
    scenario = tmp_path / "stop.yaml"
    scenario.write_text("schema: uictest/scenario/1\nname: stop\ninitial_speed: 20 km/h\n")
    command = [sys.executable, "-c", WITHOUT_COMPILER, scenario]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stdout == "1.0\n", done.stderr


@pytest.mark.slow
@pytest.mark.skipif(platform.machine() != "x86_64", reason="names a processor of this architecture")
def test_a_processor_without_fused_multiply_add_gives_the_same_bits(tmp_path):
    scenario = tmp_path / "stop.yaml"
    scenario.write_text(
        "schema: uictest/scenario/1\nname: stop\ninitial_speed: 40 km/h\nrail: {condition: wet}\n"
    )
    command = [sys.executable, "-c", ON_AN_OLD_PROCESSOR, scenario]
    done = subprocess.run(
        command,
        env=os.environ | {"UICTEST_CACHE": str(tmp_path / "cache")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout.strip() == simulate(load([scenario])[0]).measures.tobytes().hex(), done.stderr


@pytest.mark.parametrize(
    ("name", "other"),
    {
        "car": np.zeros(1, WHEELSET)[0],
        "wheelsets": np.zeros(2, WHEELSET),
        "wheelset_parameters": np.zeros(1, WHEELSET_PARAMETERS),
        "wheelset_measures": np.zeros(8, WHEELSET_MEASURES)[::2],
        "rail": np.zeros((4, 2), np.float32),
        "trace": Trace(np.zeros(0, TRAIN_SAMPLE), np.zeros((0, 4), TRAIN_SAMPLE)),
    }.items(),
)
def test_another_layout_is_refused(rig, name, other):
    """Machine code would read and write beyond it."""
    with pytest.raises(TypeError, match="contiguous"):
        compiled_stop()(*{**arguments(rig), name: other}.values())
    assert compiled_stop()(*arguments(rig).values()) == 0
