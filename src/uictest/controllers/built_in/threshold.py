"""Threshold controller: slip speed, relative slide and wheel acceleration choose fill, hold or vent.

Each wheelset runs through modes. FREE fills. When its slip exceeds the threshold or its deceleration is
more than any wheel on a good rail can have, it VENTs until the wheel has stopped losing speed, then
HOLDs while the wheel catches up, and REFILLs in pulses until the brake is back at the demand. While all
four slide nothing shows the train's speed; after a while one of them is PROBING: vented until it rolls
and shows that speed. A wheelset whose speed is not plausible (:mod:`uictest.controllers.plausibility`) has no
part in the estimate and gets the commands of the other one of its bogie; where that has no speed either, it
is filled. A dynamic brake is taken off before a valve vents, and comes back while it refills. No WSP maker
publishes thresholds: all of them are parameters.
"""

from collections.abc import Iterator, Sequence

from uictest.controllers.contract import (
    BrakedTrain,
    BrakedWheelset,
    Conflict,
    Controller,
    acceleration,
    duration,
    low_speed,
    parameter,
    share,
)
from uictest.controllers.plausibility import (
    PlausibilityParameters,
    WatchedWheelset,
    begin_watch,
    shows_speed_of_train,
    take_over,
    watch,
)
from uictest.core.physics import FILL, HOLD, VENT, maximum, minimum


class Parameters(PlausibilityParameters):
    """Fill, hold or vent by slip speed, slide and acceleration of each wheelset."""

    slip_threshold: float = low_speed("Slip speed from which a wheelset counts as sliding.")
    slide_threshold: float = share("Share of the estimated train speed that is added to the slip threshold.")
    deep_slide: float = share("Relative slide beyond which a vent goes on until the wheelset gains speed.")
    vent_deceleration: float = acceleration(
        "Deceleration of a wheelset (positive number) beyond which its tank is vented."
    )
    hold_deceleration: float = acceleration(
        "Deceleration of a wheelset (positive number) below which a vent turns into a hold."
    )
    reacceleration_threshold: float = acceleration(
        "Acceleration of a wheelset from which it counts as regaining speed."
    )
    acceleration_filter_time: float = parameter(
        "time", "Time constant of the filter of wheelset acceleration.", at_least="0 s", at_most="1 s"
    )
    holding_deceleration: float = acceleration(
        "Fall of the estimate of the train's speed while every wheelset slides (positive number)."
    )
    rolling_time: float = duration("Time in which a wheelset must not have slid to show the train's speed.")
    sounding_interval: float = duration(
        "Time without a rolling wheelset after which one is released to find the train's speed."
    )
    sounding_time: float = duration("Shortest vent of a wheelset that is released to find the train's speed.")
    recovery_share: float = share("Share of the slide threshold below which a wheelset has caught up.")
    vent_watchdog: float = duration("Longest vent; then the tank is filled again.")
    hold_limit: float = duration("Longest hold; then the tank is vented or filled.")
    fill_pulse_on: float = duration("Filling time of one pulse while the pressure is restored in steps.")
    fill_pulse_off: float = duration("Pause after such a pulse.", at_least="0 s")
    refill_time: float = duration("Time of filling in pulses after which the tank fills freely.")


class Train(BrakedTrain):
    """What the controller remembers about the train."""

    blind_cycles: int  # since a wheelset last showed the train's speed
    probed: int  # wheelset that was probed last, 0..3


class Wheelset(WatchedWheelset, BrakedWheelset):
    """What the controller reads, sets and remembers of a wheelset."""

    measured_acceleration: float  # low-pass filtered, m/s2
    mode: int  # FREE, VENTING, HOLDING, REFILLING or PROBING
    mode_cycles: int  # since the mode began


FREE = 0
VENTING = 1
HOLDING = 2
REFILLING = 3
PROBING = 4
TAKEN_OFF, LEFT_OFF = 0.2, 0.5  # of a dynamic brake: no valve waits for less; when refilling begins; chosen


def conflicts(parameters: Parameters) -> Iterator[Conflict]:
    """Yield durations too short for the controller to see, and thresholds in the wrong order."""
    for name in ("vent_watchdog", "hold_limit", "fill_pulse_on"):
        if getattr(parameters, name) < parameters.cycle_time:
            yield Conflict(name, f"{{{name}}} is shorter than one controller cycle ({{cycle_time}})")
    if parameters.holding_deceleration > parameters.reference_deceleration:
        yield Conflict("holding_deceleration", "it must not exceed reference_deceleration")
    if parameters.hold_deceleration >= parameters.vent_deceleration:
        yield Conflict("hold_deceleration", "a vent would end at once: it must be below vent_deceleration")


def begin(train: Train, wheelsets: Sequence[Wheelset], speed: float) -> None:
    """Start from rolling at ``speed`` m/s."""
    train.reference_speed = speed
    train.blind_cycles, train.probed = 0, 3
    for i in range(4):
        begin_watch(wheelsets[i], speed)
        wheelsets[i].measured_acceleration, wheelsets[i].mode, wheelsets[i].mode_cycles = 0.0, FREE, 0


def decide(train: Train, wheelsets: Sequence[Wheelset], parameters: Parameters) -> None:
    """Set the command of each wheelset; see the contract in :mod:`uictest.controllers`."""
    for i in range(4):
        _read_speed(wheelsets[i], parameters)
    watch(wheelsets, train.reference_speed, _recovered_slip(train.reference_speed, parameters), parameters)
    _estimate_speed(train, wheelsets, parameters)
    for i in range(4):
        _enter(wheelsets[i], _next_mode(wheelsets[i], train.reference_speed, parameters))
    _probe(train, wheelsets, parameters)
    for i in range(4):
        # A wheelset without a speed gets the command of the other one of its bogie.
        source = i if wheelsets[i].distrusted == 0 else i + 1 - 2 * (i % 2)
        command = _command(wheelsets[source], parameters)
        waits = command == VENT and wheelsets[i].dynamic_brake > TAKEN_OFF
        wheelsets[i].valve_command = HOLD if waits else command
        wheelsets[i].dynamic_reduction = _reduction(wheelsets[source], parameters)


def _read_speed(wheelset: Wheelset, parameters: Parameters) -> None:
    """Take over a plausible reading, differentiate it and filter the acceleration (first order)."""
    before = wheelset.plausible_speed
    elapsed = take_over(wheelset, parameters)
    if elapsed > 0.0:
        change = (wheelset.plausible_speed - before) / elapsed
        weight = parameters.cycle_time / (parameters.cycle_time + parameters.acceleration_filter_time)
        wheelset.measured_acceleration += weight * (change - wheelset.measured_acceleration)


def _slip_threshold(reference: float, parameters: Parameters) -> float:
    return parameters.slip_threshold + parameters.slide_threshold * reference


def _recovered_slip(reference: float, parameters: Parameters) -> float:
    return parameters.recovery_share * _slip_threshold(reference, parameters)


def _estimate_speed(train: Train, wheelsets: Sequence[Wheelset], parameters: Parameters) -> None:
    """Estimate the train's speed from the fastest wheelset that is trusted.

    While some wheelset rolls the estimate follows the fastest one, falling at most at the deceleration
    that a train can have. While all of them slide it falls more slowly, so that it does not sink with
    them; a probed wheelset then lowers it, at most to the speed that the train can have reached by then.
    Only a wheelset that rolls shows that the train is too slow for protection.
    """
    fastest = 0.0
    rolling, probed = False, False
    for i in range(4):
        wheelset = wheelsets[i]
        if shows_speed_of_train(wheelset):
            fastest = maximum(fastest, wheelset.plausible_speed)
        if wheelset.distrusted == 0:
            rolling = rolling or _rolls(wheelset, parameters)
            probed = probed or _shows_speed(wheelset, parameters)
    fall = parameters.reference_deceleration if rolling else parameters.holding_deceleration
    estimate = train.reference_speed - fall * parameters.cycle_time
    if probed:
        blind_time = train.blind_cycles * parameters.cycle_time
        estimate -= (parameters.reference_deceleration - parameters.holding_deceleration) * blind_time
    if rolling or probed:
        train.blind_cycles = 0
    else:
        train.blind_cycles += 1
        estimate = maximum(estimate, minimum(train.reference_speed, parameters.minimum_speed))
    train.reference_speed = maximum(fastest, estimate)


def _probe(train: Train, wheelsets: Sequence[Wheelset], parameters: Parameters) -> None:
    """Start probing the next trusted wheelset when none has shown the train's speed for too long."""
    for i in range(4):
        if wheelsets[i].mode == PROBING:
            return
    if train.blind_cycles * parameters.cycle_time > parameters.sounding_interval:
        for k in range(1, 5):
            candidate = (train.probed + k) % 4
            if wheelsets[candidate].distrusted == 0:
                train.probed = candidate
                _enter(wheelsets[candidate], PROBING)
                return


def _rolls(wheelset: Wheelset, parameters: Parameters) -> bool:
    """Return True once a wheelset has been free for so long that it must roll."""
    time_in_mode = wheelset.mode_cycles * parameters.cycle_time
    return bool(wheelset.mode == FREE and time_in_mode > parameters.rolling_time)


def _shows_speed(wheelset: Wheelset, parameters: Parameters) -> bool:
    """Return True once a probed wheelset rolls: it gains no speed and loses no more than a train can."""
    time_in_mode = wheelset.mode_cycles * parameters.cycle_time
    if wheelset.mode != PROBING or time_in_mode < parameters.sounding_time:
        return False
    acceleration = wheelset.measured_acceleration
    return bool(-parameters.reference_deceleration <= acceleration <= parameters.reacceleration_threshold)


def _enter(wheelset: Wheelset, mode: int) -> None:
    if mode == wheelset.mode:
        wheelset.mode_cycles += 1
    else:
        wheelset.mode, wheelset.mode_cycles = mode, 0


def _next_mode(wheelset: Wheelset, reference: float, parameters: Parameters) -> int:
    slip = reference - wheelset.plausible_speed
    time_in_mode = (wheelset.mode_cycles + 1) * parameters.cycle_time
    if reference < parameters.minimum_speed or wheelset.distrusted == 1:
        return FREE
    if wheelset.mode == PROBING:
        spent = _shows_speed(wheelset, parameters) or time_in_mode > parameters.vent_watchdog
        return REFILLING if spent else PROBING
    if wheelset.mode == VENTING:
        return _after_venting(wheelset, slip, reference, time_in_mode, parameters)
    if wheelset.mode == HOLDING:
        return _after_holding(wheelset, slip, reference, time_in_mode, parameters)
    if _slides(wheelset, slip, _slip_threshold(reference, parameters), parameters):
        return VENTING
    refills = wheelset.mode == REFILLING and time_in_mode <= parameters.refill_time
    return REFILLING if refills else FREE


def _slides(wheelset: Wheelset, slip: float, threshold: float, parameters: Parameters) -> bool:
    """Return True when the wheel slides: slip above the threshold without recovery, or an impossible fall."""
    losing = wheelset.measured_acceleration < parameters.reacceleration_threshold
    falling = wheelset.measured_acceleration < -parameters.vent_deceleration
    return bool((slip > threshold and losing) or falling)


def _after_venting(
    wheelset: Wheelset, slip: float, reference: float, time_in_mode: float, parameters: Parameters
) -> int:
    """Return the mode after a vent: hold once the wheel loses no speed, or in a deep slide gains some."""
    deep = slip > parameters.deep_slide * reference
    enough = parameters.reacceleration_threshold if deep else -parameters.hold_deceleration
    if wheelset.measured_acceleration > enough:
        return HOLDING
    return REFILLING if time_in_mode > parameters.vent_watchdog else VENTING


def _after_holding(
    wheelset: Wheelset, slip: float, reference: float, time_in_mode: float, parameters: Parameters
) -> int:
    """Return the mode that follows a hold: refill once the wheel has caught up, else vent again."""
    if slip < _recovered_slip(reference, parameters):
        return REFILLING
    enough = 0.0 if slip > parameters.deep_slide * reference else -parameters.vent_deceleration
    if wheelset.measured_acceleration < enough:
        return VENTING
    if time_in_mode > parameters.hold_limit:
        return VENTING if wheelset.measured_acceleration < parameters.reacceleration_threshold else HOLDING
    return HOLDING


def _command(wheelset: Wheelset, parameters: Parameters) -> int:
    """Return the valve command of a mode; refilling alternates fill and hold."""
    if wheelset.mode == VENTING or wheelset.mode == PROBING:
        return VENT
    if wheelset.mode == HOLDING:
        return HOLD
    if wheelset.mode == REFILLING:
        on = round(parameters.fill_pulse_on / parameters.cycle_time)
        pulse = on + round(parameters.fill_pulse_off / parameters.cycle_time)
        return FILL if wheelset.mode_cycles % pulse < on else HOLD
    return FILL


def _reduction(wheelset: Wheelset, parameters: Parameters) -> float:
    """Return the share that a mode takes off the dynamic brake: all; half and ever less while refilling."""
    if wheelset.mode == REFILLING:
        time_left = parameters.refill_time - wheelset.mode_cycles * parameters.cycle_time
        return LEFT_OFF * maximum(time_left / parameters.refill_time, 0.0)
    return 0.0 if wheelset.mode == FREE else 1.0


CONTROLLER = Controller(
    name="threshold",
    parameters=Parameters,
    train_memory=Train,
    wheelset_memory=Wheelset,
    begin=begin,
    decide=decide,
    conflicts=conflicts,
    contract=2,
)
