"""The samples of a recorded stop for a fit: motion, torques and loads of the wheelsets."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording import TIME, Recording
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans import scenario
from uictest.plans.scenario import WHEELSET_NUMBERS, Scenario, wheelset_value
from uictest.recorded import field_data
from uictest.recorded.field_data import WHEELSETS

_WHEELS = 8


def wheel_loads(vehicle: scenario.Vehicle, deceleration: Array) -> Array:
    """Return the load of one wheel of each wheelset, N, shape (4, n), at decelerations in m/s2.

    The body leans on the leading bogie, each bogie on its leading wheelset: moments about the rail, springs
    at rest. Body and bogie pull at each other at the heights of link and secondary springs, shared by
    stiffness.
    """
    body, bogie, wheelset = vehicle.loaded_body, vehicle.bogie, vehicle.wheelset
    height = _coupling_height(vehicle)
    lean = body.mass * (body.height - height) / (2.0 * vehicle.half_pivot_distance)
    moments = 0.5 * body.mass * height + bogie.mass * bogie.height + 2.0 * wheelset.mass * wheelset.radius
    rotating = np.array(vehicle.rotational_inertias).reshape(2, 2).sum(axis=1) / wheelset.radius
    turning = (moments + rotating) / (2.0 * bogie.half_wheelbase)
    shares = np.array(
        [0.25 * b * lean + 0.5 * w * turning[j] for j, b in enumerate((1.0, -1.0)) for w in (1.0, -1.0)]
    )
    static = vehicle.total_mass * STANDARD_GRAVITY / _WHEELS
    loads: Array = static + np.outer(shares, deceleration)
    return loads


def _coupling_height(vehicle: scenario.Vehicle) -> float:
    sides = 2.0
    spring = sides * vehicle.secondary.longitudinal_stiffness
    link = vehicle.traction_link.stiffness
    return (spring * vehicle.secondary.height + link * vehicle.traction_link.height) / (spring + link)


Array = NDArray[np.float64]
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
        place: of each wheelset on the track, m from where the first was at the brake command.
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
    place: Array
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
    speed = _smoothed(np.asarray(recording["speed"])[part], width)
    wheels = np.array([_smoothed(np.asarray(recording[name])[part], width) for name in names[1:]])
    slip = speed - wheels
    loads = _of_wheelsets(recording, "wheel_load", part, width)
    if loads is None:
        loads = wheel_loads(scenario.vehicle, -np.gradient(_smoothed(speed, 5 * width), time))
    return StopSamples(
        time,
        speed,
        wheels,
        slip,
        np.asarray(recording["distance"])[part] - _behind(scenario)[:, None],
        loads,
        _torque(recording, scenario, part, width),
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
    spoilt = [str(defect) for defect in stop.defects if defect.spoils and defect.channel in names]
    holes = [name for name in (*names, "distance") if not np.isfinite(stop.recording[name]).all()]
    if spoilt or holes:
        defects = spoilt + [f"{name} has gaps" for name in holes]
        raise FitError(f"a fit needs speeds without defects: {'; '.join(defects)}")
    if stop.trigger.late:
        raise FitError("the record begins after the brake command, so places on the track are not known")


def _require_wheels_alone(recording: Recording, scenario: Scenario) -> None:
    """Raise FitError where a track brake slowed the train, or may have: a fit takes that for the wheels'."""
    force = recording.channels.get("track_brake_force")
    if np.nanmax(force, initial=0.0) > 0.0 if force is not None else scenario.brake.track is not None:
        raise FitError("a track brake slowed the train: the deceleration is not that of its wheels")


def _smoothed(samples: Array, width: int) -> Array:
    """Return the moving average over an odd number of samples, shorter and still centred near the ends."""
    half = width // 2
    reach = np.minimum(half, np.minimum(np.arange(len(samples)), np.arange(len(samples))[::-1]))
    summed = np.concatenate(([0.0], np.cumsum(samples)))
    k = np.arange(len(samples))
    average: Array = (summed[k + reach + 1] - summed[k - reach]) / (2 * reach + 1)
    return average


def _behind(scenario: Scenario) -> Array:
    """Return how far each wheelset runs behind the first, m."""
    pivots = 2.0 * scenario.vehicle.half_pivot_distance
    base = 2.0 * scenario.vehicle.bogie.half_wheelbase
    return np.array([0.0, base, pivots, pivots + base])


def of_wheelsets(scenario: Scenario, name: str) -> Array:
    """Return a value of each wheelset by its name below ``vehicle.wheelsets.N``, SI, shape (4, 1)."""
    return np.array([[float(wheelset_value(scenario, number, name))] for number in WHEELSET_NUMBERS])


def _torque(recording: Recording, scenario: Scenario, part: slice, width: int) -> Array | None:
    """Return the brake torque by the clamping forces and the scenario's pads, else as recorded.

    It is averaged like the speeds, so that both sides of a balance are. Of pads that vary with speed or
    temperature, and beside a dynamic brake, the forces alone do not say the torque.
    """
    disc = scenario.brake.system.disc
    pads = of_wheelsets(scenario, "pad_friction") * of_wheelsets(scenario, "brake_force")
    per_force = disc.calipers_per_wheelset * disc.pads_per_caliper * disc.mean_radius * pads
    sources = (("clamping_force", per_force), ("brake_torque", np.ones_like(per_force)))
    by_torque_alone = scenario.brake.pad.varies or scenario.brake.dynamic is not None
    for kind, factor in sources[1:] if by_torque_alone else sources:
        if (samples := _of_wheelsets(recording, kind, part, width)) is not None:
            return np.asarray(factor * samples)
    return None


def _of_wheelsets(recording: Recording, kind: str, part: slice, width: int) -> Array | None:
    """Return the smoothed samples of a kind of channel, (4, n); None where one has gaps or is missing."""
    names = [f"{kind}_{n}" for n in WHEELSETS]
    if any(name not in recording.channels or not np.isfinite(recording[name]).all() for name in names):
        return None
    return np.array([_smoothed(np.asarray(recording[name])[part], width) for name in names])
