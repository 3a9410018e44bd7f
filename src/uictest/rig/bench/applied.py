"""What a bench test applies, from the inputs of its recipe."""

from dataclasses import replace
from pathlib import Path

from uictest.core.units import BAR
from uictest.plans.scenario import Case
from uictest.rig import identification
from uictest.rig.bench.recipe import (
    BenchTest,
    FileReplay,
    Input,
    Random,
    Rest,
    Stepwise,
    StopReplay,
    Triangular,
    WspCycling,
)
from uictest.rig.bench.rig import (
    BenchInput,
    Clock,
    clock_of,
    joined_inputs,
    random_input,
    recorded_input,
    stepwise_input,
    triangular_input,
    wsp_cycling_input,
)
from uictest.rig.simulation import simulate


def bench_input(test: BenchTest) -> BenchInput:
    """Return demanded pressures and valve commands of a recipe; stops that it replays are simulated.

    Raises UnsuitableRecordError or OSError for a recording that cannot be used.
    """
    clock = clock_of(test.case)
    return joined_inputs(_segment(segment, test, clock) for segment in test.recipe.inputs)


def _segment(segment: Input, test: BenchTest, clock: Clock) -> BenchInput:
    match segment:
        case StopReplay():
            return _simulated_stop(segment, test.case, clock)
        case FileReplay():
            return _recorded_file(segment, test.folder, clock)
        case WspCycling():
            return _wsp_cycling(segment, clock)
        case Rest(duration=duration):
            return stepwise_input([0.0], duration, clock)
        case Stepwise(levels=levels, hold=hold):
            return stepwise_input(levels, hold, clock)
        case Triangular(peaks=peaks, floor=floor, ramp=ramp):
            return triangular_input(peaks, floor, BAR / ramp, clock)
        case Random(lowest=lowest, highest=highest):
            return random_input(lowest, highest, segment.interval, segment.duration, segment.seed, clock)


def _wsp_cycling(segment: WspCycling, clock: Clock) -> BenchInput:
    return wsp_cycling_input(
        segment.pressure,
        segment.lead,
        segment.cycles,
        segment.vent,
        segment.hold,
        segment.fill,
        segment.seed,
        clock,
    )


def _simulated_stop(segment: StopReplay, case: Case, clock: Clock) -> BenchInput:
    rail = case.scenario.rail.model_copy(update={"friction": segment.friction})
    brake = case.scenario.brake
    if segment.position is not None:
        brake = brake.model_copy(update={"position": segment.position})
    scenario = case.scenario.model_copy(update={"rail": rail, "brake": brake, "seed": segment.seed})
    recording = simulate(replace(case, scenario=scenario), clock.cycle_time).recording
    assert recording is not None
    commands = recording[f"valve_command_{segment.wheelset}"]
    return recorded_input(recording["time"], recording["demanded_pressure"], commands, clock)


def _recorded_file(segment: FileReplay, folder: Path, clock: Clock) -> BenchInput:
    names = {"pressure": segment.pressure}
    if segment.command is not None:
        names["command"] = segment.command
    channels = identification.read_record(folder / segment.file, names).channels
    return recorded_input(channels["time"], channels["pressure"], channels.get("command"), clock)
