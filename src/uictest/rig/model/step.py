"""One base step of the whole rig."""

from collections.abc import Sequence

from uictest.rig.model.clamping import step_clamping
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.pneumatics import step_air
from uictest.rig.model.running_gear import (
    account_for_brakes,
    begin_forces,
    clear_forces,
    couple_body,
    couple_wheelset,
    step_body,
    step_frame,
    step_wheelset,
)
from uictest.rig.model.slip_search import find_slips
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
