"""Threshold controller: slip speed, relative slide and wheel acceleration choose fill, hold or vent.

Each wheelset runs through modes. FREE fills. When its slip exceeds the threshold or its deceleration is
more than any wheel on a good rail can have, it VENTs until the wheel has stopped losing speed, then
HOLDs while the wheel catches up, and REFILLs in pulses until the brake is back at the demand. While all
four slide nothing tells the train's speed; after a while one of them is SOUNDING: vented until it rolls
and shows that speed. No WSP maker publishes thresholds: all of them are parameters.
"""

from uictest.controllers.contract import Car, Parameters, Wheelset, Wheelsets
from uictest.physics import FILL, HOLD, VENT, maximum, minimum

CAR_MEMORY = (
    ("reference_speed", "f8"),  # estimate of the train's speed, m/s
    ("blind_cycles", "i8"),  # since a wheelset last showed the train's speed
    ("sounded", "i8"),  # wheelset that was sounding last, 0..3
)
WHEELSET_MEMORY = (
    ("previous_speed", "f8"),  # measured in the cycle before, m/s
    ("measured_acceleration", "f8"),  # low-pass filtered, m/s2
    ("mode", "i8"),  # FREE, VENTING, HOLDING, REFILLING or SOUNDING
    ("mode_cycles", "i8"),  # since the mode began
)

FREE = 0
VENTING = 1
HOLDING = 2
REFILLING = 3
SOUNDING = 4


def begin(car: Car, wheelsets: Wheelsets, speed: float) -> None:
    """Start from rolling at ``speed`` m/s."""
    car.reference_speed = speed
    car.blind_cycles = 0
    car.sounded = 3
    for i in range(4):
        wheelset = wheelsets[i]
        wheelset.previous_speed = speed
        wheelset.measured_acceleration = 0.0
        wheelset.mode = FREE
        wheelset.mode_cycles = 0


def decide(car: Car, wheelsets: Wheelsets, parameters: Parameters) -> None:
    """Set the command of each wheelset; see the contract in :mod:`uictest.controllers`."""
    for i in range(4):
        _differentiate(wheelsets[i], parameters)
    _estimate_speed(car, wheelsets, parameters)
    for i in range(4):
        _enter(wheelsets[i], _next_mode(wheelsets[i], car.reference_speed, parameters))
    _sound(car, wheelsets, parameters)
    for i in range(4):
        wheelsets[i].command = _command(wheelsets[i], parameters)


def _differentiate(wheelset: Wheelset, parameters: Parameters) -> None:
    """Differentiate the measured speed and filter the acceleration (first order)."""
    change = (wheelset.measured_speed - wheelset.previous_speed) / parameters.cycle_time
    share = parameters.cycle_time / (parameters.cycle_time + parameters.acceleration_filter_time)
    wheelset.measured_acceleration += share * (change - wheelset.measured_acceleration)
    wheelset.previous_speed = wheelset.measured_speed


def _estimate_speed(car: Car, wheelsets: Wheelsets, parameters: Parameters) -> None:
    """Estimate the train's speed from the fastest wheelset.

    While some wheelset rolls the estimate follows the fastest one, falling at most at the deceleration
    that a train can have. While all of them slide it falls more slowly, so that it does not sink with
    them; a sounding then lowers it, at most to what the train can have come down to meanwhile. Only a
    wheelset that rolls can tell that the train is too slow for protection.
    """
    fastest = 0.0
    rolling = False
    sounded = False
    for i in range(4):
        wheelset = wheelsets[i]
        fastest = maximum(fastest, wheelset.measured_speed)
        rolling = rolling or _rolls(wheelset, parameters)
        sounded = sounded or _shows_speed(wheelset, parameters)
    fall = parameters.reference_deceleration if rolling else parameters.holding_deceleration
    estimate = car.reference_speed - fall * parameters.cycle_time
    if sounded:
        blind_time = car.blind_cycles * parameters.cycle_time
        estimate -= (parameters.reference_deceleration - parameters.holding_deceleration) * blind_time
    if rolling or sounded:
        car.blind_cycles = 0
    else:
        car.blind_cycles += 1
        estimate = maximum(estimate, minimum(car.reference_speed, parameters.minimum_speed))
    car.reference_speed = maximum(fastest, estimate)


def _sound(car: Car, wheelsets: Wheelsets, parameters: Parameters) -> None:
    """Begin to sound the next wheelset when for too long none has shown the train's speed."""
    for i in range(4):
        if wheelsets[i].mode == SOUNDING:
            return
    if car.blind_cycles * parameters.cycle_time > parameters.sounding_interval:
        car.sounded = (car.sounded + 1) % 4
        _enter(wheelsets[car.sounded], SOUNDING)


def _rolls(wheelset: Wheelset, parameters: Parameters) -> bool:
    """Whether a wheelset has been free for so long that it must roll."""
    time_in_mode = wheelset.mode_cycles * parameters.cycle_time
    return bool(wheelset.mode == FREE and time_in_mode > parameters.rolling_time)


def _shows_speed(wheelset: Wheelset, parameters: Parameters) -> bool:
    """Whether a sounding wheelset, vented for a while, neither gains speed nor loses more than trains do."""
    time_in_mode = wheelset.mode_cycles * parameters.cycle_time
    if wheelset.mode != SOUNDING or time_in_mode < parameters.sounding_time:
        return False
    gains = wheelset.measured_acceleration > parameters.reacceleration_threshold
    loses = wheelset.measured_acceleration < -parameters.reference_deceleration
    return not (gains or loses)


def _enter(wheelset: Wheelset, mode: int) -> None:
    """Go on in the same mode or begin another."""
    if mode == wheelset.mode:
        wheelset.mode_cycles += 1
    else:
        wheelset.mode = mode
        wheelset.mode_cycles = 0


def _next_mode(wheelset: Wheelset, reference: float, parameters: Parameters) -> int:
    """Mode of the wheelset for the coming cycle."""
    slip = reference - wheelset.measured_speed
    threshold = parameters.slip_threshold + parameters.slide_threshold * reference
    time_in_mode = (wheelset.mode_cycles + 1) * parameters.cycle_time
    if reference < parameters.minimum_speed:
        return FREE
    if wheelset.mode == SOUNDING:
        spent = _shows_speed(wheelset, parameters) or time_in_mode > parameters.vent_watchdog
        return REFILLING if spent else SOUNDING
    if wheelset.mode == VENTING:
        return _after_venting(wheelset, slip, reference, time_in_mode, parameters)
    if wheelset.mode == HOLDING:
        return _after_holding(wheelset, slip, reference, threshold, time_in_mode, parameters)
    if _slides(wheelset, slip, threshold, parameters):
        return VENTING
    if wheelset.mode == REFILLING and time_in_mode <= parameters.refill_time:
        return REFILLING
    return FREE


def _slides(wheelset: Wheelset, slip: float, threshold: float, parameters: Parameters) -> bool:
    """Whether the wheel loses grip: too much slip without catching up, or a fall no rolling wheel shows."""
    losing = wheelset.measured_acceleration < parameters.reacceleration_threshold
    falling = wheelset.measured_acceleration < -parameters.vent_deceleration
    return bool((slip > threshold and losing) or falling)


def _after_venting(
    wheelset: Wheelset, slip: float, reference: float, time_in_mode: float, parameters: Parameters
) -> int:
    """Mode that follows a vent: hold once the wheel loses no more speed, in a deep slide once it gains speed.

    A locked wheel loses no speed either, and only goes on turning when it is vented further.
    """
    deep = slip > parameters.deep_slide * reference
    enough = parameters.reacceleration_threshold if deep else -parameters.hold_deceleration
    if wheelset.measured_acceleration > enough:
        return HOLDING
    return REFILLING if time_in_mode > parameters.vent_watchdog else VENTING


def _after_holding(
    wheelset: Wheelset,
    slip: float,
    reference: float,
    threshold: float,
    time_in_mode: float,
    parameters: Parameters,
) -> int:
    """Mode that follows a hold: refill once the wheel has caught up, vent again when it does not."""
    if slip < parameters.recovery_share * threshold:
        return REFILLING
    deep = slip > parameters.deep_slide * reference
    if wheelset.measured_acceleration < (0.0 if deep else -parameters.vent_deceleration):
        return VENTING
    if time_in_mode > parameters.hold_limit:
        return VENTING if wheelset.measured_acceleration < parameters.reacceleration_threshold else HOLDING
    return HOLDING


def _command(wheelset: Wheelset, parameters: Parameters) -> int:
    """Valve command of a mode; refilling alternates fill and hold."""
    if wheelset.mode == VENTING or wheelset.mode == SOUNDING:
        return VENT
    if wheelset.mode == HOLDING:
        return HOLD
    if wheelset.mode == REFILLING:
        on = round(parameters.fill_pulse_on / parameters.cycle_time)
        off = round(parameters.fill_pulse_off / parameters.cycle_time)
        return FILL if wheelset.mode_cycles % (on + off) < on else HOLD
    return FILL
