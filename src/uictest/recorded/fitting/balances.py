"""Samples of a recorded stop for a fit, and balances of momentum over short windows of it.

A wheelset of inertia J that slides under friction mu0, over a window of length T:

    J [omega(T) - omega(0)] = integral of r F(w, v, Q, mu0) - M

and the train of mass m:

    m [v(T) - v(0)] = - integral of sum F_i + R(v) + m g gradient

with F by the creep law at the *recorded* slip speed where a wheelset slides, and from its own balance where
it does not. The closed loop of WSP and wheel never runs, so nothing here is chaotic, and integrals need no
derivative of a noisy speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.physics import contact_stiffness, creep_force, fma, maximum, select
from uictest.core.recording import TIME, Recording
from uictest.core.translation import translate
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans import scenario
from uictest.plans.scenario import WHEELSET_NUMBERS, Scenario, wheelset_value
from uictest.recorded import field_data
from uictest.recorded.field_data import WHEELSETS

Array = NDArray[np.float64]

_WHEELS = 8


def wheel_loads(vehicle: scenario.Vehicle, deceleration: Array) -> Array:
    """Return the load of one wheel of each wheelset, N, shape (4, n), at decelerations in m/s2.

    The load transfer is quasi-static, with springs at rest: the body loads the leading bogie, and each bogie
    its leading wheelset, by the moments about the rail. Body and bogie act on each other at the mean height
    of traction link and secondary springs, weighted by stiffness. A load transfer per deceleration is in kg.
    """
    body, bogie, wheelset = vehicle.loaded_body, vehicle.bogie, vehicle.wheelset
    coupling_height = _coupling_height(vehicle)
    transfer_to_bogie = body.mass * (body.height - coupling_height) / (2.0 * vehicle.half_pivot_distance)
    mass_moment = (
        0.5 * body.mass * coupling_height + bogie.mass * bogie.height + 2.0 * wheelset.mass * wheelset.radius
    )
    rotating_moment = np.array(vehicle.rotational_inertias).reshape(2, 2).sum(axis=1) / wheelset.radius
    transfer_in_bogie = (mass_moment + rotating_moment) / (2.0 * bogie.half_wheelbase)
    transfer_per_wheel = np.array(
        [
            0.25 * bogie_sign * transfer_to_bogie + 0.5 * wheelset_sign * transfer_in_bogie[j]
            for j, bogie_sign in enumerate((1.0, -1.0))
            for wheelset_sign in (1.0, -1.0)
        ]
    )
    static = vehicle.total_mass * STANDARD_GRAVITY / _WHEELS
    loads: Array = static + np.outer(transfer_per_wheel, deceleration)
    return loads


def _coupling_height(vehicle: scenario.Vehicle) -> float:
    sides = 2.0
    spring = sides * vehicle.secondary.longitudinal_stiffness
    link = vehicle.traction_link.stiffness
    return (spring * vehicle.secondary.height + link * vehicle.traction_link.height) / (spring + link)


_SMOOTHING = 0.1
"""s over which speeds are averaged before differences are taken of them; chosen."""
_THIRD_DIFFERENCE = 0.6745 * 20.0**0.5
"""Median size of the third differences of a normal noise, over its standard deviation."""


class FitError(ValueError):
    """A recording that a fit cannot use; the message says what is missing."""


@dataclass(frozen=True, slots=True, eq=False)
class StopSamples:
    """A recorded stop while the train moves. Wheelset arrays have shape (4, n).

    Args:
        time: since the brake command, s.
        speed: of the train, smoothed, m/s.
        wheel_speed: circumferential, smoothed, m/s.
        slip: slip speed, m/s.
        position: of each wheelset on the track, m from where the first was at the brake command.
        load: of one wheel, N, as recorded, else of the vehicle at its deceleration.
        torque: of the brake on each wheelset, N m; None where no clamping forces or torques are recorded.
        sliding: where a wheelset slides, by the scenario's definition.
        standing: where a wheelset is locked: its brake then holds, and its torque is not known.
        noise: standard deviation of that of `speed`, m/s, by the third differences of what was recorded.

    """

    time: Array
    speed: Array
    wheel_speed: Array
    slip: Array
    position: Array
    load: Array
    torque: Array | None
    sliding: NDArray[np.bool_]
    standing: NDArray[np.bool_]
    noise: float

    def without_delay(self, delay: float) -> StopSamples:
        """Return the samples of wheel speeds that are recorded so many seconds after the train speed."""
        wheel_speed = self.wheel_speed + delay * np.gradient(self.wheel_speed, self.time, axis=1)
        return replace(self, wheel_speed=wheel_speed, slip=self.speed - wheel_speed)


def samples_of(stop: field_data.RecordedStop, scenario: Scenario) -> StopSamples:
    """Return the samples for a fit. Raises FitError if channels are missing or defective."""
    recording = stop.recording
    names = ("speed", *(f"wheel_speed_{n}" for n in WHEELSETS))
    _require_sound_speeds(stop, names)
    _require_wheels_alone(recording, scenario)
    definition = scenario.measures
    moving = np.asarray(recording["speed"]) > definition.moving_speed
    count = len(moving) if moving.all() else int(np.argmin(moving))
    if count < 10:
        raise FitError("the train hardly runs in this record")
    part = slice(0, count)
    time = np.asarray(recording[TIME])[part]
    width = max(round(_SMOOTHING / (time[1] - time[0])), 1)
    speed = _moving_average(np.asarray(recording["speed"])[part], width)
    wheels = np.array([_moving_average(np.asarray(recording[name])[part], width) for name in names[1:]])
    slip = speed - wheels
    loads = _wheelset_channels(recording, "wheel_load", part, width)
    if loads is None:
        loads = wheel_loads(scenario.vehicle, -np.gradient(_moving_average(speed, 5 * width), time))
    return StopSamples(
        time,
        speed,
        wheels,
        slip,
        np.asarray(recording["distance"])[part] - _distances_from_first_wheelset(scenario)[:, None],
        loads,
        _brake_torque(recording, scenario, part, width),
        (slip > definition.sliding_slip) & (slip > definition.sliding_slide * speed),
        wheels < 2.0 * definition.locked_speed,
        float(np.median(np.abs(np.diff(recording["speed"][part], 3)))) / _THIRD_DIFFERENCE / width**0.5,
    )


def _require_sound_speeds(stop: field_data.RecordedStop, names: tuple[str, ...]) -> None:
    missing = [name for name in names if name not in stop.recording.channels]
    if missing:
        raise FitError(
            f"a fit needs the train speed and all wheel speeds; not recorded: {', '.join(missing)}"
        )
    unusable = [str(defect) for defect in stop.defects if defect.makes_unusable and defect.channel in names]
    holes = [name for name in (*names, "distance") if not np.isfinite(stop.recording[name]).all()]
    if unusable or holes:
        defects = unusable + [f"{name} has gaps" for name in holes]
        raise FitError(f"a fit needs speeds without defects: {'; '.join(defects)}")
    if stop.trigger.late:
        raise FitError("the record begins after the brake command, so positions on the track are not known")


def _require_wheels_alone(recording: Recording, scenario: Scenario) -> None:
    """Raise FitError where a track brake slowed the train, or may have: a fit takes that for the wheels'."""
    force = recording.channels.get("track_brake_force")
    if np.nanmax(force, initial=0.0) > 0.0 if force is not None else scenario.brake.track is not None:
        raise FitError("a track brake slowed the train: the deceleration is not that of its wheels")


def _moving_average(samples: Array, width: int) -> Array:
    """Return the moving average over an odd number of samples, shorter and still centred near the ends."""
    half = width // 2
    reach = np.minimum(half, np.minimum(np.arange(len(samples)), np.arange(len(samples))[::-1]))
    summed = np.concatenate(([0.0], np.cumsum(samples)))
    k = np.arange(len(samples))
    average: Array = (summed[k + reach + 1] - summed[k - reach]) / (2 * reach + 1)
    return average


def _distances_from_first_wheelset(scenario: Scenario) -> Array:
    """Return the distance from the first wheelset to each of the four, m."""
    pivots = 2.0 * scenario.vehicle.half_pivot_distance
    base = 2.0 * scenario.vehicle.bogie.half_wheelbase
    return np.array([0.0, base, pivots, pivots + base])


def of_wheelsets(scenario: Scenario, name: str) -> Array:
    """Return a value of each wheelset by its name below ``vehicle.wheelsets.N``, SI, shape (4, 1)."""
    return np.array([[float(wheelset_value(scenario, number, name))] for number in WHEELSET_NUMBERS])


def _brake_torque(recording: Recording, scenario: Scenario, part: slice, width: int) -> Array | None:
    """Return the brake torque by the clamping forces and the scenario's pads, else as recorded.

    It is averaged like the speeds, so that both sides of a balance are. Of pads that vary with speed or
    temperature, and with a dynamic brake, the forces alone do not say the torque.
    """
    disc = scenario.brake.system.disc
    pads = of_wheelsets(scenario, "pad_friction") * of_wheelsets(scenario, "brake_force")
    per_force = disc.calipers_per_wheelset * disc.pads_per_caliper * disc.mean_radius * pads
    sources = (("clamping_force", per_force), ("brake_torque", np.ones_like(per_force)))
    by_torque_alone = scenario.brake.pad.varies or scenario.brake.dynamic is not None
    for kind, factor in sources[1:] if by_torque_alone else sources:
        if (samples := _wheelset_channels(recording, kind, part, width)) is not None:
            return np.asarray(factor * samples)
    return None


def _wheelset_channels(recording: Recording, kind: str, part: slice, width: int) -> Array | None:
    """Return the smoothed samples of a kind of channel, (4, n); None where one has gaps or is missing."""
    names = [f"{kind}_{n}" for n in WHEELSETS]
    if any(name not in recording.channels or not np.isfinite(recording[name]).all() for name in names):
        return None
    return np.array([_moving_average(np.asarray(recording[name])[part], width) for name in names])


# numpy has no fused multiply-add, and a fit does not need its last bit.
_FOR_ARRAYS: dict[Any, Any] = {fma: lambda a, b, c: a * b + c, maximum: np.maximum, select: np.where}


def wheelset_creep_force(
    slip: Array,
    speed: Array,
    load: Array,
    friction: Array,
    rail: scenario.RailCondition,
    clean: tuple[scenario.CreepCurve, Array] | None = None,
) -> Array:
    """Return the force of the rail on a wheelset of two wheels, N.

    Args:
        slip: slip speed v - r omega, m/s, positive while braking.
        speed: running speed, m/s, > 0.
        load: of one wheel, N.
        friction: initial friction coefficient under the wheelset.
        rail: the other parameters of the law.
        clean: those of a clean rail and the cleaned share, where they differ.

    """
    contact = rail.contact
    area = np.pi * contact.semi_axis_longitudinal * contact.semi_axis_lateral
    reference = 0.25 * contact.shear_modulus * area * contact.kalker_coefficient
    load_ratio = load / float(contact.reference_wheel_load)
    force, _ = _vectorized(creep_force)(
        slip,
        speed,
        load,
        _vectorized(contact_stiffness)(float(reference), load_ratio),
        friction,
        *(_blended_with_clean(float(getattr(rail, name)), name, clean) for name in _SHAPE),
    )
    wheels = 2.0
    total: Array = wheels * force
    return total


_SHAPE: Final = ("friction_ratio", "friction_decay", "reduction_adhesion", "reduction_slip")


def _blended_with_clean(
    as_found: float, name: str, clean: tuple[scenario.CreepCurve, Array] | None
) -> float | Array:
    """Return a number of the creep curve, which goes over to that of a clean rail with the cleaned share."""
    if clean is None:
        return as_found
    curve, share = clean
    return as_found + share * (float(getattr(curve, name)) - as_found)


@cache
def _vectorized(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function of the rig's creep law with numpy's functions for its scalar ones."""
    translated: Callable[..., Any] = translate(function, lambda f: f, dict(_FOR_ARRAYS))
    return translated


Mask = NDArray[np.bool_]
WINDOW = 0.25
"""s; chosen: longer than the noise of the sensors, shorter than a cycle of the WSP."""


@dataclass(frozen=True, slots=True, eq=False)
class Windows:
    """Windows of a stop: `first` and `last` sample of each, and what every wheelset does in them, (4, k)."""

    first: NDArray[np.intp]
    last: NDArray[np.intp]
    sliding: Mask
    standing: Mask


def windows_of(samples: StopSamples) -> Windows:
    """Cut a stop into windows; a wheelset slides in one if it does at every sample of it."""
    length = max(round(WINDOW / (samples.time[1] - samples.time[0])), 2)
    first = np.arange(0, len(samples.time) - length, length)
    last = first + length
    spans = list(zip(first, last, strict=True))
    sliding = np.array([samples.sliding[:, a : b + 1].all(axis=1) for a, b in spans]).T
    standing = np.array([samples.standing[:, a : b + 1].any(axis=1) for a, b in spans]).T
    return Windows(first, last, sliding, standing)


def over(windows: Windows, samples: StopSamples, values: Array) -> Array:
    """Return the integral of values (..., n) over each window, (..., k), by trapezoids."""
    steps = 0.5 * (values[..., 1:] + values[..., :-1]) * np.diff(samples.time)
    summed = np.concatenate((np.zeros((*values.shape[:-1], 1)), np.cumsum(steps, axis=-1)), axis=-1)
    integral: Array = summed[..., windows.last] - summed[..., windows.first]
    return integral


@dataclass(frozen=True, eq=False)
class Balances:
    """The balances of a stop, whose residuals are adhesion coefficients: 0.01 is a hundredth of the load."""

    samples: StopSamples
    windows: Windows
    scenario: Scenario

    def rail_impulse(self, friction: Array, share: Array | None) -> Array:
        """Return the impulse of the rail on each wheelset by the creep law, N s, (4, k).

        Arguments are those of :meth:`residuals`.
        """
        s, rail = self.samples, self.scenario.rail
        curve = None if rail.cleaning_in_force is None else rail.cleaning_in_force.clean_curve
        clean = None if curve is None or share is None else (curve, share)
        slip = np.maximum(s.slip, 0.0)
        force = wheelset_creep_force(slip, s.speed, s.load, friction, rail.condition, clean)
        return over(self.windows, s, force)

    def brake_impulse(self, brake_factor: float) -> Array | None:
        """Return the impulse of the rail by the balance of each wheelset, N s, (4, k); else None."""
        if self.samples.torque is None:
            return None
        torque = brake_factor * self._torque_impulse
        impulse: Array = (torque + self._inertia * self._angular_velocity_gain) / self._radius
        return impulse

    def residuals(self, friction: Array, share: Array | None, brake_factor: float) -> tuple[Array, Array]:
        """Return the residuals of the balances of sliding wheelsets, and of the train.

        The train's are those of windows in which all impulses are known.

        Args:
            friction: initial friction coefficient under each wheelset, (4, n).
            share: cleaned share of the rail under it, (4, n); None where nothing is cleaned.
            brake_factor: on the torque of the brakes.
        """
        by_rail, by_brake = self.rail_impulse(friction, share), self.brake_impulse(brake_factor)
        of_wheelsets, impulse, load = np.empty(0), by_rail, self._load_impulse
        if by_brake is not None:
            of_wheelsets = ((by_rail - by_brake) / load)[self._known_balances[0]]
            impulse = np.where(self.windows.sliding, by_rail, by_brake)
        of_train = (impulse.sum(axis=0) - self.lost_momentum) / load.sum(axis=0)
        return of_wheelsets, np.asarray(of_train[self._known_balances[1]])

    @cached_property
    def _known_balances(self) -> tuple[Mask, Mask]:
        """Where a balance is known: of which wheelset in which window, (4, k), and of the train, (k,)."""
        sliding, known = self.windows.sliding, ~self.windows.standing & (self.samples.torque is not None)
        return sliding & known, np.asarray((sliding | known).all(axis=0))

    def noise_variance(self, row: int) -> float:
        """Return the variance that noise of the train speed adds to the mean of `row` consecutive residuals.

        Between windows that follow each other it cancels. Wheelsets are so light that theirs hardly counts.
        """
        known = self._known_balances[1]
        single = self.scenario.vehicle.total_mass * self.samples.noise / self._load_impulse.sum(axis=0)
        followed = np.count_nonzero(known[1:] & known[:-1]) / np.count_nonzero(known)
        return 2.0 * float(np.mean(single[known] ** 2)) * (1.0 - (1.0 - 1.0 / row) * followed) / row

    @cached_property
    def lost_momentum(self) -> Array:
        """The impulse of the rails by the deceleration of the train, N s, (k,)."""
        s, vehicle = self.samples, self.scenario.vehicle
        resistance = vehicle.running_resistance
        drag = resistance.constant + resistance.linear * s.speed + resistance.quadratic * s.speed**2
        drag = drag + vehicle.total_mass * STANDARD_GRAVITY * float(self.scenario.rail.gradient)
        lost = vehicle.total_mass * (s.speed[self.windows.first] - s.speed[self.windows.last])
        return np.asarray(lost - over(self.windows, s, drag))

    def adhesion_used(self) -> Array:
        """Return the adhesion each wheelset used in each window, (4, k): by its brake, else by the train."""
        needed = self.brake_impulse(1.0)
        if needed is None:
            shared = self.lost_momentum / self._load_impulse.sum(axis=0)
            return np.broadcast_to(shared, self.windows.sliding.shape)
        return np.asarray(needed / self._load_impulse)

    @cached_property
    def _radius(self) -> Array:
        return of_wheelsets(self.scenario, "wheel_radius")

    @cached_property
    def _inertia(self) -> Array:
        return of_wheelsets(self.scenario, "rotational_inertia")

    @cached_property
    def _angular_velocity_gain(self) -> Array:
        """Gain of angular velocity of each wheelset over each window, rad/s, (4, k)."""
        speed = self.samples.wheel_speed
        return np.asarray((speed[:, self.windows.last] - speed[:, self.windows.first]) / self._radius)

    @cached_property
    def _torque_impulse(self) -> Array:
        assert self.samples.torque is not None
        return over(self.windows, self.samples, self.samples.torque)

    @cached_property
    def _load_impulse(self) -> Array:
        wheels = 2.0
        return wheels * over(self.windows, self.samples, self.samples.load)
