"""The compensation of a rig identified from the bench, once for each rig, and kept in the user's cache."""

import logging
from collections.abc import Iterable
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from threading import Lock
from typing import Any, Final

import uictest
from uictest.core import user_cache
from uictest.core.recording import ORIGIN
from uictest.plans.scenario import (
    COMPENSATION_SETTINGS,
    BrakeSystem,
    Compensation,
    Files,
    Parts,
    Quantity,
    Scenario,
    rig_as_built,
    with_listed_rig,
)
from uictest.plans.scenario.yaml import Document, parse, quantities_in
from uictest.rig import identification
from uictest.rig.bench.identified_air import identify_air
from uictest.rig.bench.recipe import (
    BenchTest,
    Random,
    Stepwise,
    StopReplay,
    Triangular,
    load_bench,
    recipe_path,
)
from uictest.rig.bench.run import run_test
from uictest.rig.kernel.library import source_digest

_BENCHES: Final = {"hysteresis": "six-inch-hysteresis", "pressure": "six-inch-cylinder"}
_BASE: Final = "six-inch"
"""The compensation whose numbers the search for those of the air starts from."""
_ACTING_TIME, _TRANSITION_TIME, _HELD_OUT = 2.0, 0.1, 0.25
"""As the defaults of `uictest identify`: s, s and a share."""
_identifying = Lock()
_texts: dict[str, str] = {}
"""Compensation files of this process by the digest of what they depend on; only under the lock."""


def identified_compensation(scenario: Scenario) -> Compensation:
    """Return the compensation of a scenario's rig, identified as its setting of the compensation needs it."""
    pressure = COMPENSATION_SETTINGS[scenario.rig.compensation].pressure
    subjects = ("hysteresis",) if pressure == "tank" else ("hysteresis", pressure)
    inputs = _inputs(scenario, subjects)
    with _identifying:
        text = _kept_or_identified(inputs, scenario, pressure)
    return with_listed_rig(_part(text), scenario)


def _inputs(scenario: Scenario, subjects: Iterable[str]) -> bytes:
    """Return everything that the numbers depend on: those of the rig, the benches, the program."""
    import scipy

    parts = scenario.rig.caliper, scenario.brake.system, scenario.rig.sensors
    numbers = [[(key, float(value)) for key, value in quantities_in(part)] for part in parts]
    benches = [recipe_path(name).read_bytes() for name in _BENCHES.values()]
    stated = (
        numbers,
        scenario.rig.sensors.speed.method,
        tuple(subjects),
        uictest.__version__,
        scipy.__version__,
    )
    return b"".join([repr(stated).encode(), *benches, source_digest().encode()])


def _kept_or_identified(inputs: bytes, scenario: Scenario, pressure: str) -> str:
    digest = sha256(inputs).hexdigest()
    if digest not in _texts:
        content = user_cache.read("compensation", inputs)
        if content is None:
            logging.getLogger(__name__).warning(
                "uictest: identifying a compensation from the bench (once for each rig, some minutes)..."
            )
            content = _identify(scenario, pressure, f"identified-{digest[:8]}").encode()
            user_cache.write("compensation", inputs, content)
        _texts[digest] = content.decode()
    return _texts[digest]


def _part(text: str) -> Compensation:
    """Read a compensation file. Raises ScenarioErrors for one that holds anything else."""
    tree = parse(Document("identified", Path(), text))
    part: Compensation = Parts(Files()).part(tree, Compensation, ()).part
    return part


def _identify(scenario: Scenario, pressure: str, name: str) -> str:
    channels, provenance = _record(_BENCHES["hysteresis"], scenario)
    acting = identification.wsp_acting_from_commands(
        channels["time"], channels["valve_command_1"], _ACTING_TIME
    )
    lines = identification.identify_hysteresis(
        channels["time"],
        channels["cylinder_pressure_1"],
        channels["clamping_force_1"],
        acting,
        _TRANSITION_TIME,
        _HELD_OUT,
    )
    identification.require_force_fit(lines)
    base = identification.load_compensation(_BASE)
    text = identification.with_hysteresis(base, name, lines, provenance, _ACTING_TIME, _TRANSITION_TIME)
    if pressure == "tank":
        return text
    channels, provenance = _record(_BENCHES["pressure"], scenario)
    if pressure == "filter":
        filtered = identification.identify_cylinder(
            channels["time"], channels["measured_pressure_2"], channels["cylinder_pressure_1"], _HELD_OUT
        )
        identification.require_fit(filtered)
        return identification.with_cylinder(_part(text), name, filtered, provenance)
    air = {
        "time": channels["time"],
        "tank": channels["measured_pressure_2"],
        "cylinder": channels["cylinder_pressure_1"],
        "line": channels["brake_line_pressure"],
        "command": channels["valve_command_1"],
    }
    case = _on_rig(load_bench(recipe_path(_BENCHES["pressure"])), scenario).case
    air_result = identify_air(air, case, _HELD_OUT, starts_near=base.air)
    return identification.with_air(_part(text), name, air_result, provenance)


def _record(bench: str, scenario: Scenario) -> tuple[dict[str, Any], identification.Provenance]:
    """Return the channels of a bench test on a rig. Raises UnsuitableRecordError where loadcells saturate."""
    recording = run_test(_on_rig(load_bench(recipe_path(bench)), scenario))
    reach, largest = scenario.rig.sensors.loadcell.range, float(recording["clamping_force_1"].max())
    if largest >= reach - scenario.rig.sensors.loadcell.resolution:
        raise identification.UnsuitableRecordError(
            f"the bench {bench} drives the loadcells to the end of their range, {reach.text}: give"
            " rig.sensors.loadcell.range more"
        )
    digest = identification.samples_digest({name: recording[name] for name in recording.channels})
    built = {key: value.text for key, value in rig_as_built(scenario).items()}
    command = "rig.compensation_model: identify"
    origin = recording.metadata[ORIGIN]
    facts = identification.Provenance(bench, digest, digest, origin, command, uictest.__version__, rig=built)
    return recording.channels, facts


def _strongest(system: BrakeSystem) -> tuple[str, float]:
    """Return the position of a brake with the highest pressure, and that, gauge, Pa."""
    pressures = {name: float(each.maximum_pressure) for name, each in system.positions.items()}
    return max(pressures.items(), key=lambda item: item[1])


def _on_rig(test: BenchTest, scenario: Scenario) -> BenchTest:
    """Return a bench test on the caliper, brake and sensors of a scenario, its pressures in proportion."""
    stop, system = test.case.scenario, scenario.brake.system
    strongest, highest = _strongest(system)
    _, written_for = _strongest(stop.brake.system)
    scale = highest / written_for
    position = stop.brake.position if stop.brake.position in system.positions else strongest
    rig = {"caliper": scenario.rig.caliper, "sensors": scenario.rig.sensors}
    brake = {"system": system, "position": position}
    changed = stop.model_copy(
        update={"rig": stop.rig.model_copy(update=rig), "brake": stop.brake.model_copy(update=brake)}
    )

    def scaled(pressure: Quantity) -> Quantity:
        return Quantity(scale * pressure, pressure.text, pressure.unit, pressure.source)

    segments = []
    for segment in test.recipe.inputs:
        changes: dict[str, Any] = {}
        match segment:
            case Triangular():
                changes = {"peaks": tuple(map(scaled, segment.peaks)), "floor": scaled(segment.floor)}
            case Stepwise():
                changes = {"levels": tuple(map(scaled, segment.levels))}
            case Random():
                changes = {"lowest": scaled(segment.lowest), "highest": scaled(segment.highest)}
            case StopReplay() if segment.position not in system.positions:
                changes = {"position": strongest}
        segments.append(segment.model_copy(update=changes))
    recipe = test.recipe.model_copy(update={"inputs": tuple(segments)})
    return replace(test, recipe=recipe, case=replace(test.case, scenario=changed))
