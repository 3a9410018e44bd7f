"""Open a controller from outside for one stop, and say what went wrong in it."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

import numpy as np

from uictest.controllers import (
    CLOSING,
    EXCHANGE,
    FORBIDDEN_COMMAND,
    NO_FAILURE,
    NO_MAGNET_STATE,
    NOT_CALLED,
    OPENING,
    STEP_FAILED,
    WROTE_BEYOND,
    Config,
    ControllerError,
    ControllerInstance,
    ControllerProgram,
    open_controller,
)

_FAILURES: Final = {
    STEP_FAILED: "step failed: {error}",
    FORBIDDEN_COMMAND: "forbidden command for wheelset {wheelset}: vent without hold",
    NO_MAGNET_STATE: "a magnet of wheelset {wheelset} is neither 0 nor 1: hold {hold}, vent {vent}",
    WROTE_BEYOND: "the controller wrote beyond its outputs",
}


def empty_exchange() -> Any:
    """Return a record of :data:`~uictest.controllers.EXCHANGE` in memory of its own."""
    return np.zeros(1, EXCHANGE)[0]


@contextmanager
def opened(
    program: ControllerProgram, config: Config, parameters: Any, exchange: Any
) -> Iterator[ControllerInstance]:
    """Open a controller, reset it, and tell the stop with these parameters where it is.

    Raises:
        ControllerError: when it cannot be loaded, created or reset, and after a stop in which it failed.
    """
    exchange["calling"] = OPENING
    try:
        instance = open_controller(program, config)
        try:
            instance.reset()
            exchange["calling"] = NOT_CALLED
            parameters["controller_step"] = instance.step_address
            parameters["controller_handle"] = instance.handle
            parameters["controller_exchange"] = exchange.__array_interface__["data"][0]
            yield instance
            raise_failure(exchange, instance)
        finally:
            exchange["calling"] = CLOSING
            instance.close()
    finally:
        # Also where it could not be opened: whoever watches a block asks which controller does not return.
        exchange["calling"] = NOT_CALLED


def raise_failure(exchange: Any, instance: ControllerInstance) -> None:
    """Raise ControllerError if the controller failed, with the reason and the cycle."""
    failure = int(exchange["failure"])
    if failure == NO_FAILURE:
        return
    place = int(exchange["failed_wheelset"])
    reason = _FAILURES[failure].format(
        error=instance.last_error() or "no reason given",
        wheelset=place + 1,
        hold=exchange["hold"][place],
        vent=exchange["vent"][place],
    )
    raise ControllerError(f"{reason} (cycle {exchange['cycle']})")
