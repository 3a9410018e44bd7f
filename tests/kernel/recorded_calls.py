"""Keeps calls of the kernel and what they gave on this machine: recorded_calls.py stops|lanes FOLDER.

Into the folder go `calls`, `results` and `digest`. A call is the name of a function (64 bytes), the number of
blocks of memory and of arguments, the size of each block, two whole numbers for each argument (a block and a
place in it, or -1 and a number), then what the blocks hold. Its result is what it returns, then what the
blocks hold afterwards. What a function takes is asked of its description alone. The digest is of the measures
of the stops in lanes, whatever their width.
"""

import ctypes
import hashlib
import struct
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from uictest.rig.kernel import library
from uictest.rig.kernel.arguments import leaves, passed

REPOSITORY = Path(__file__).parents[2]
SCENARIOS = REPOSITORY / "scenarios"
FAULTY = REPOSITORY / "examples" / "faults" / "slip-120-with-fault.yaml"
NAME = 64
"""Bytes of a name."""


class Recorder:
    """Takes the place of what makes a function of the kernel."""

    def __init__(self, folder):
        self.calls, self.results = (folder / "calls").open("wb"), (folder / "results").open("wb")

    def native_function(self, entry, level=None):
        """Return a function of the kernel whose calls are kept."""
        function = library.function_of_addresses(entry, level)
        arguments = list(leaves(entry.arguments))

        def call(*values):
            numbers = passed(entry.arguments, values)
            lengths, given = numbers[: -len(arguments)], numbers[-len(arguments) :]
            sizes = [0 if at is int else v.nbytes for at, v in zip(arguments, leaves(values), strict=True)]
            described = list(zip(arguments, given, sizes, strict=True))
            blocks = joined((n, n + size) for at, n, size in described if at is not int)
            pairs = [(-1, length) for length in lengths]
            pairs += [(-1, n) if at is int else placed(n, blocks) for at, n, _ in described]
            head = (len(blocks), len(pairs), *(end - start for start, end in blocks), *sum(pairs, ()))
            self.calls.write(entry.symbol.encode().ljust(NAME, b"\0") + struct.pack(f"<{len(head)}q", *head))
            self.calls.writelines(ctypes.string_at(start, end - start) for start, end in blocks)
            returned = function(*numbers)
            self.results.write(struct.pack("<q", returned))
            self.results.writelines(ctypes.string_at(start, end - start) for start, end in blocks)
            return returned

        return call


def joined(ranges):
    """Return ranges of memory in their order, those that overlap as one: an array may be part of another."""
    blocks = []
    for start, end in sorted(ranges):
        if blocks and start < blocks[-1][1]:
            blocks[-1] = blocks[-1][0], max(end, blocks[-1][1])
        else:
            blocks.append((start, end))
    return blocks


def placed(address, blocks):
    """Return the block that an address is in, and how far behind its start."""
    number = max(n for n, (start, _) in enumerate(blocks) if start <= address)
    return number, address - blocks[number][0]


def record_stops(folder, cases):
    """Run stops of cars alone and in trains, a bench test, and a recording that is judged again."""
    from uictest import rig
    from uictest.core.measures import MeasureDefinition, Replay, samples_of
    from uictest.core.record import fields_of
    from uictest.plans import scenario
    from uictest.rig import bench
    from uictest.rig.external.in_process import run_in_process
    from uictest.selftest.known_stops import KnownStops

    for case in (*KnownStops().cases.values(), *cases):
        if case.train is None:
            run_in_process(rig.assemble(case))
    rig.simulate(cases[0])  # with its reference distance
    for cars in trains():
        rig.simulate_cars(cars[:1])
    bench.run_test(bench.load_bench(bench.recipe_path("wsp-cycling"), (), None, ()))
    [case] = scenario.load([FAULTY])
    numbers = {name: getattr(case.scenario.measures, name) for name in fields_of(MeasureDefinition)}
    recording = rig.simulate(case, record_every=0.02).recording
    samples = samples_of(recording.channels, np.full((len(recording["time"]), 4), 9e3), None)
    rig.pass_samples(Replay(samples, SimpleNamespace(**numbers), 3.8e5))
    return b""


def record_lanes(folder, cases):
    """Run the stops of cars alone side by side, and those of trains."""
    from uictest import rig
    from uictest.rig.lanes import run_in_lanes

    inputs = [rig.assemble(case) for case in cases if case.train is None]
    batch = run_in_lanes(*rig.stacked(inputs))
    stops = [stop for train in rig.simulate_trains(trains()) for stop in train]
    of_trains = [each.tobytes() for stop in stops for each in (stop.measures, stop.wheelset_measures)]
    return b"".join([*(each.tobytes() for each in batch), *of_trains])


def trains():
    """Return two trains, each its cars."""
    from uictest.plans import scenario

    other = ["brake.command=70 %", "rail.friction=0.07"]
    return [scenario.load([SCENARIOS / "train-120.yaml"], overrides) for overrides in ([], other)]


def main():
    kind, folder = sys.argv[1], Path(sys.argv[2])
    folder.mkdir()
    early = {f"uictest.rig.{name}" for name in ("lanes", "queue", "stepped", "stops")}.intersection(
        sys.modules
    )
    assert not early, "the rig would call functions that were made before"
    library.native_function = Recorder(folder).native_function
    from uictest.plans import scenario

    record = {"stops": record_stops, "lanes": record_lanes}[kind]
    measures = record(folder, scenario.load([SCENARIOS]))
    (folder / "digest").write_text(hashlib.sha256(measures).hexdigest(), "utf-8")


if __name__ == "__main__":
    main()
