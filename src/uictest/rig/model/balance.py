"""Balances of energy and air: what came in, what is left, what was turned into heat or let out."""

from collections.abc import Sequence

from uictest.core.physics import kinetic_energy, longitudinal, spring_energy, vertical
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Bogie, Car, Frame, Wheelset


def stored_energy(car: Car, bogies: Sequence[Bogie], wheelsets: Sequence[Wheelset], p: Parameters) -> float:
    """Kinetic energy, energy of the springs and of the height gained on the gradient, J.

    Within a step a force is constant and does its work with the mean of the speeds at both ends, while
    positions advance with the speed at the end. The places that belong to that work lie half a step behind,
    and with them springs and gradient give back what was put in.
    """
    energy: float = _frame_energy(car, p.body_mass, p.body_inertia, p)
    for j in range(2):
        bogie = bogies[j]
        energy += _frame_energy(bogie, p.bogie_mass, p.bogie_inertia, p)
        energy += _secondary_energy(car, bogie, p)
    for i in range(4):
        energy += _wheelset_energy(wheelsets[i], bogies[i // 2], p)
    return energy


def _frame_energy(frame: Frame, mass: float, inertia: float, p: Parameters) -> float:
    motion = kinetic_energy(mass, frame.speed) + kinetic_energy(mass, frame.vertical_speed)
    height: float = p.gradient * _behind(frame.position, frame.speed, p)
    return motion + kinetic_energy(inertia, frame.pitch_rate) + mass * float(p.gravity) * height


def _secondary_energy(car: Car, bogie: Bogie, p: Parameters) -> float:
    rise = _height(car, bogie.ahead, p) - _height(bogie, 0.0, p)
    energy = spring_energy(p.secondary_vertical_stiffness, rise)
    energy += spring_energy(p.secondary_longitudinal_stiffness, _shift(car, bogie, p.secondary_height, p))
    return energy + spring_energy(p.link_stiffness, _shift(car, bogie, p.link_height, p))


def _shift(car: Car, bogie: Bogie, height: float, p: Parameters) -> float:
    return _place(car, height - p.body_height, p) - _place(bogie, height - p.bogie_height, p)


def _place(frame: Frame, above: float, p: Parameters) -> float:
    position, pitch = _behind(frame.position, frame.speed, p), _behind(frame.pitch, frame.pitch_rate, p)
    return longitudinal(position, pitch, above)


def _height(frame: Frame, ahead: float, p: Parameters) -> float:
    height, pitch = (
        _behind(frame.height, frame.vertical_speed, p),
        _behind(frame.pitch, frame.pitch_rate, p),
    )
    return vertical(height, pitch, ahead)


def _behind(position: float, speed: float, p: Parameters) -> float:
    """Position, height or pitch half a step ago."""
    return position - 0.5 * float(p.step) * speed


def _wheelset_energy(wheelset: Wheelset, bogie: Bogie, p: Parameters) -> float:
    position = _behind(wheelset.position, wheelset.speed, p)
    shift = position - _place(bogie, wheelset.wheel_radius - p.bogie_height, p)
    rise = _height(bogie, wheelset.ahead, p)
    springs = spring_energy(p.primary_longitudinal_stiffness, shift) + spring_energy(
        p.primary_vertical_stiffness, rise
    )
    motion: float = kinetic_energy(p.wheelset_mass, wheelset.speed) + kinetic_energy(
        wheelset.rotational_inertia, wheelset.rotation
    )
    height: float = p.gradient * position
    return springs + motion + float(p.wheelset_mass * p.gravity) * height


def rail_work(wheelset: Wheelset, p: Parameters) -> float:
    """Work of the rail on a wheelset since the brake command, against its motion, J.

    What the rail takes from the motion of the wheelset becomes heat of its contacts, work of its brakes or
    rotation. What the brakes draw from the pitching of the bogie, some ten joules, is in it as well.
    """
    turned = kinetic_energy(wheelset.rotational_inertia, wheelset.rotation)
    turned_first = kinetic_energy(wheelset.rotational_inertia, p.initial_speed / wheelset.wheel_radius)
    braked = wheelset.brake_heat + wheelset.dynamic_energy
    return braked + wheelset.contact_loss + (turned - turned_first)


def energy_residual(car: Car, bogies: Sequence[Bogie], wheelsets: Sequence[Wheelset], p: Parameters) -> float:
    """Energy that is not accounted for, as a share of the energy at the start.

    kinetic + springs + height = initial + traction + work of the couplers - (disc heat + work of the dynamic
    brake + contact loss + track brake + dampers + running resistance)
    """
    lost = car.damper_loss + car.resistance_loss - car.traction_work - car.coupler_work
    lost += car.track_brake_energy
    for i in range(4):
        lost += wheelsets[i].brake_heat + wheelsets[i].contact_loss
        lost += wheelsets[i].dynamic_energy
    residual: float = stored_energy(car, bogies, wheelsets, p) + lost - car.initial_energy
    return residual / float(car.initial_energy)


def stored_air(car: Car, wheelsets: Sequence[Wheelset]) -> float:
    """Air in the reservoir, the brake line and the tanks, kg."""
    air: float = car.reservoir_mass + car.line_mass
    for i in range(4):
        air += wheelsets[i].air_mass
    return air


def air_residual(car: Car, wheelsets: Sequence[Wheelset]) -> float:
    """Air that is not accounted for, as a share of what was taken from the reservoir."""
    released = car.exhausted_air + car.leaked_air
    for i in range(4):
        released += wheelsets[i].vented_air + wheelsets[i].leaked_air
    balance: float = stored_air(car, wheelsets) + released - car.compressor_air - car.initial_air
    return balance / float(car.consumed_air)


def stored_air_energy(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> float:
    """Internal energy of the air in the brake line and the tanks, m cv T, J.

    The reservoir keeps its temperature, so that its air takes from the wall whatever leaves it as enthalpy.
    """
    energy: float = car.line_mass * car.line_temperature
    for i in range(4):
        energy += wheelsets[i].air_mass * wheelsets[i].air_temperature
    return energy * float(p.heat_capacity_volume)


def air_energy_residual(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> float:
    """Energy of the air that is not accounted for, as a share of the enthalpy taken from the reservoir.

    internal energy = initial + supplied - let out + heat from the walls - work on the pistons
    """
    gained: float = car.supplied_enthalpy - car.exhausted_enthalpy + car.line_heat - car.leaked_enthalpy
    for i in range(4):
        wheelset = wheelsets[i]
        gained += wheelset.wall_heat - wheelset.vented_enthalpy - wheelset.piston_work
        gained -= wheelset.leaked_enthalpy
    balance: float = stored_air_energy(car, wheelsets, p) - car.initial_air_energy - gained
    return balance / float(car.supplied_enthalpy)
