"""One base step of the whole rig."""

from collections.abc import Sequence

from uictest.rig.model.clamping import step_clamping
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.pneumatics import step_air
from uictest.rig.model.running_gear import (
    bracket_slip,
    clear_forces,
    couple_body,
    couple_wheelset,
    find_friction_limit,
    find_stress_gradient,
    heat_disc,
    refine_slip,
    step_body,
    step_frame,
    step_wheelset,
)
from uictest.rig.model.state import Bogie, Car, Wheelset


def step(car: Car, bogies: Sequence[Bogie], wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Advance everything by ``p.step``: air, clamping forces, wheelsets on the rail, vehicle.

    Nothing branches and nothing is looked up: what happens once per controller cycle is in
    :mod:`uictest.rig.model.cycle`.
    """
    step_air(car, wheelsets, p)
    step_clamping(wheelsets[0], p)
    step_clamping(wheelsets[1], p)
    step_clamping(wheelsets[2], p)
    step_clamping(wheelsets[3], p)
    _step_vehicle(car, bogies, wheelsets, p)
    car.steps += 1.0
    car.substep += 1.0
    car.time = car.steps * p.step


def _step_vehicle(car: Car, bogies: Sequence[Bogie], wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    leading = bogies[0]
    trailing = bogies[1]
    clear_forces(car)
    clear_forces(leading)
    clear_forces(trailing)
    couple_body(car, leading, p)
    couple_body(car, trailing, p)
    couple_wheelset(wheelsets[0], leading, car, p)
    couple_wheelset(wheelsets[1], leading, car, p)
    couple_wheelset(wheelsets[2], trailing, car, p)
    couple_wheelset(wheelsets[3], trailing, car, p)
    _solve_slip(wheelsets, p)
    step_wheelset(wheelsets[0], leading, p)
    step_wheelset(wheelsets[1], leading, p)
    step_wheelset(wheelsets[2], trailing, p)
    step_wheelset(wheelsets[3], trailing, p)
    step_frame(leading, p.bogie_mass, p.bogie_mass_response, p.bogie_pitch_response, 0.0, p)
    step_frame(trailing, p.bogie_mass, p.bogie_mass_response, p.bogie_pitch_response, 0.0, p)
    heat_disc(wheelsets[0], leading, p)
    heat_disc(wheelsets[1], leading, p)
    heat_disc(wheelsets[2], trailing, p)
    heat_disc(wheelsets[3], trailing, p)
    step_body(car, p)


def _solve_slip(wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Take two Newton steps for each wheelset; the first finds the force at the last slip speed."""
    for i in range(4):
        bracket_slip(wheelsets[i], p)
    _find_creep(wheelsets, p)
    for i in range(4):
        wheelsets[i].sliding_force = refine_slip(wheelsets[i], p)
    _find_creep(wheelsets, p)
    for i in range(4):
        refine_slip(wheelsets[i], p)


def _find_creep(wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Find friction limit and stress side by side: the processor then works on all four chains at once."""
    for i in range(4):
        find_friction_limit(wheelsets[i], p)
    for i in range(4):
        find_stress_gradient(wheelsets[i], p)
