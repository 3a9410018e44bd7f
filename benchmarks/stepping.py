"""What it costs to step the rig from outside, per controller cycle: `python benchmarks/stepping.py [turns]`.

Every candidate drives the same stop without slide protection. The FMU is called through FMPy, with its inputs
set and the four wheel speeds read in every step; it is left out where FMPy or a C compiler is missing.
"""

import contextlib
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import machine
from stops import SCENARIOS
from timing import seconds

import uictest
from uictest.rig import SteppedTrain, alone, assemble

STOP = SCENARIOS / "slip-120.yaml"
FILLING = [0, 0, 0, 0]
Stop = Callable[[], int]
"""Runs a stop and returns its number of cycles."""


def machine_code() -> Stop:
    """Return the stop stepped without leaving numpy records: what the others add is theirs."""
    case = uictest.Rig(STOP).case

    def run() -> int:
        stop, cycles = SteppedTrain(alone(assemble(case))), 0
        while not stop.has_ended:
            stop.step()
            cycles += 1
        return cycles

    return run


def rig() -> Stop:
    """Return the stop stepped by `uictest.Rig`."""
    stepped = uictest.Rig(STOP)

    def run() -> int:
        inputs = stepped.reset()
        while not stepped.stopped:
            inputs = stepped.step(hold=FILLING, vent=FILLING)
        return inputs.cycle

    return run


def fmu(folder: str) -> Stop:
    """Return the stop stepped through FMPy."""
    import fmpy
    from fmpy.fmi2 import FMU2Slave

    from uictest.api.fmu import build_fmu

    path = Path(folder, "rig.fmu")
    path.write_bytes(build_fmu(uictest.Rig(STOP).case, 2))
    described: Any = fmpy.read_model_description(str(path))
    number = {each.name: each.valueReference for each in described.modelVariables}
    magnets = [number[f"{name}_{i}"] for name in ("hold", "vent") for i in (1, 2, 3, 4)]
    speeds = [number[f"wheel_speed_{i}"] for i in (1, 2, 3, 4)]
    slave = FMU2Slave(
        guid=described.guid,
        unzipDirectory=fmpy.extract(str(path), folder),
        modelIdentifier=described.coSimulation.modelIdentifier,
        instanceName="rig",
    )
    slave.instantiate()

    def run() -> int:
        slave.reset()
        slave.setupExperiment()
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        cycles = 0
        while not slave.getBoolean([number["ended"]])[0]:
            slave.getReal(speeds)
            slave.setBoolean(magnets, FILLING * 2)
            slave.doStep(0.01 * cycles, 0.01)
            cycles += 1
        return cycles

    return run


def main(turns: int) -> None:
    """Time all candidates in turns and print the median per cycle."""
    print(machine.description("numpy"))
    with tempfile.TemporaryDirectory() as folder:
        candidates: dict[str, Stop] = {"machine code": machine_code(), "uictest.Rig": rig()}
        with contextlib.suppress(ImportError):
            candidates["FMU by FMPy"] = fmu(folder)
        times: dict[str, list[float]] = {name: [] for name in candidates}
        cycles = {name: run() for name, run in candidates.items()}
        for _ in range(turns):
            for name, run in candidates.items():
                times[name].append(seconds(run, time.thread_time) / cycles[name])
    print(f"\n{turns} turns, {max(cycles.values())} cycles")
    for name, per_cycle in times.items():
        print(f"{name:14}{1e6 * median(per_cycle):8.1f} us per cycle")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
