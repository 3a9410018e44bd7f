"""One base step of the whole rig: of its brake, then of its vehicle.

Within a controller cycle nothing that the vehicle does acts on air, calipers or compensation, and the vehicle
needs the clamping forces alone. So the brake may make the steps of a cycle before the vehicle makes them:
lanes do, whose processor then finds more of what it works on in its registers and its first-level cache.
"""

from collections.abc import Sequence

from uictest.core.physics import select
from uictest.rig.model.friction_brake import (
    compensate,
    read_loadcells,
    read_pressure,
    step_caliper,
    step_clamping,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.pneumatics import step_air
from uictest.rig.model.running_gear import (
    account_for_brakes,
    begin_forces,
    clear_forces,
    couple_body,
    couple_wheelset,
    find_slips,
    step_body,
    step_frame,
    step_wheelset,
)
from uictest.rig.model.state import Bogie, Car, ModuleStep, Wheelset


def step_brake(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Advance the brake by ``p.step``: air and clamping forces, also of calipers that a rig does not have."""
    step_air(car, wheelsets, p)
    for i in range(4):
        step_clamping(wheelsets[i], p)
    _count_step(car, p)


def step_modules(
    car: Car, wheelsets: Sequence[Wheelset], module_steps: Sequence[ModuleStep], p: Parameters
) -> None:
    """Advance air and the first caliper, which every rig has; keep what the sensors read."""
    step_air(car, wheelsets, p)
    _step_caliper(wheelsets[0], module_steps[0], p)
    for i in range(4):
        read_pressure(wheelsets[i], p)
        module_steps[i].pressure_reading = wheelsets[i].pressure_reading
        module_steps[i].pressure_ratio = wheelsets[i].pressure_ratio
    wheelsets[0].compensated_pressure = wheelsets[0].pressure_reading
    _count_step(car, p)


def step_other_calipers(
    wheelsets: Sequence[Wheelset], module_steps: Sequence[ModuleStep], p: Parameters
) -> None:
    """Advance the calipers of the other modules; nothing reads those that a rig does not have."""
    for i in range(1, 4):
        _step_caliper(wheelsets[i], module_steps[i], p)


def compensate_kept(wheelset: Wheelset, module_step: ModuleStep, p: Parameters) -> None:
    """Compute the clamping force of a module from what is kept of a step, unless its loadcells read it."""
    wheelset.pressure_reading = module_step.pressure_reading
    wheelset.pressure_ratio = module_step.pressure_ratio
    compensate(wheelset, p)
    has_caliper = wheelset.has_caliper > 0.0
    module_step.clamping_force = select(has_caliper, module_step.clamping_force, wheelset.computed_force)


def take_clamping_forces(wheelsets: Sequence[Wheelset], module_steps: Sequence[ModuleStep]) -> None:
    """Give the vehicle the clamping forces that are kept of a step."""
    for i in range(4):
        wheelsets[i].clamping_force = module_steps[i].clamping_force


def _step_caliper(wheelset: Wheelset, module_step: ModuleStep, p: Parameters) -> None:
    step_caliper(wheelset, p)
    module_step.clamping_force = read_loadcells(wheelset, p)


def _count_step(car: Car, p: Parameters) -> None:
    car.steps += 1.0
    car.substep += 1.0
    car.time = car.steps * p.step


def step_vehicle(car: Car, bogies: Sequence[Bogie], wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Advance wheelsets, bogies and car body under the clamping forces."""
    leading = bogies[0]
    trailing = bogies[1]
    clear_forces(car)
    begin_forces(leading)
    begin_forces(trailing)
    couple_body(car, leading, p)
    couple_body(car, trailing, p)
    thrust_0 = couple_wheelset(wheelsets[0], leading, car, p)
    thrust_1 = couple_wheelset(wheelsets[1], leading, car, p)
    thrust_2 = couple_wheelset(wheelsets[2], trailing, car, p)
    thrust_3 = couple_wheelset(wheelsets[3], trailing, car, p)
    slips, forces = find_slips(wheelsets, (thrust_0, thrust_1, thrust_2, thrust_3), p)
    torques_0 = step_wheelset(wheelsets[0], leading, thrust_0, forces[0], slips[0], p)
    torques_1 = step_wheelset(wheelsets[1], leading, thrust_1, forces[1], slips[1], p)
    torques_2 = step_wheelset(wheelsets[2], trailing, thrust_2, forces[2], slips[2], p)
    torques_3 = step_wheelset(wheelsets[3], trailing, thrust_3, forces[3], slips[3], p)
    step_frame(leading, p.bogie_mass, p.bogie_mass_response, p.bogie_pitch_response, 0.0, p)
    step_frame(trailing, p.bogie_mass, p.bogie_mass_response, p.bogie_pitch_response, 0.0, p)
    account_for_brakes(wheelsets[0], leading, torques_0, p)
    account_for_brakes(wheelsets[1], leading, torques_1, p)
    account_for_brakes(wheelsets[2], trailing, torques_2, p)
    account_for_brakes(wheelsets[3], trailing, torques_3, p)
    step_body(car, p)
    car.vehicle_steps += 1.0
