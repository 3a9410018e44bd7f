"""The result of every adapter: a controller that compiled code calls by address."""

import ctypes
import hashlib
import json
import math
import sys
import traceback
from abc import ABC, abstractmethod
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import product
from operator import index
from pathlib import Path
from struct import Struct
from typing import Any, Final, NamedTuple

from uictest.controllers.declared import CONTRACTS, ControllerProgram, nothing_declared, parameter_problems
from uictest.controllers.interface import INPUTS, OUTPUT_BYTES, OUTPUTS, WHEELSETS, Inputs, Outputs

STEP: Final = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)
"""`uictest_step`."""
_LARGEST_DIAGNOSIS: Final = 2**32 - 1
_PACKAGE: Final = Path(__file__).parents[2]
_LONGEST: Final = 2000
"""Characters of what is told about a failure; chosen: a reason stands in every report."""


class ControllerError(Exception):
    """A controller cannot be loaded, or failed; the message says why.

    `output` is what it printed in its stop, where that is kept.
    """

    output = ""

    def __init__(self, message: str) -> None:
        more = " ..." if len(message) > _LONGEST else ""
        super().__init__(message[:_LONGEST] + more)


class OnlyOneError(ControllerError):
    """A controller cannot be loaded because one of its kind is open, and a process can have only one."""


def unchanged_content(path: Path, sha256: str) -> bytes:
    """Return the content of a program's file. Raises ControllerError where it is another than was read."""
    content = path.read_bytes()
    if hashlib.sha256(content).hexdigest() != sha256:
        raise ControllerError(f"{path.name} has changed since the scenario was read")
    return content


@dataclass(frozen=True, slots=True)
class ResponseTimes:
    """How a controller answered in a stop that was paced by the clock.

    Cycle ``k`` is due ``k`` cycle times after the first one began. Its inputs are sent then, or once the
    answer before has come. Its deadline is the instant at which cycle ``k + 1`` is due.

    Attributes:
        answers: number of answers.
        cycle_time_s: time from one cycle to the next.
        missed_deadlines: answers that came after their deadline.
        longest_answer_s: longest time from sending the inputs of a cycle to its answer.
        longest_answer_cycle: the cycle that took it.
        start_jitter_s: longest time from the instant at which a cycle is due to the instant at which its
            inputs are sent, without the cycles after a missed deadline: how well this machine keeps time.
    """

    answers: int
    cycle_time_s: float
    missed_deadlines: int
    longest_answer_s: float
    longest_answer_cycle: int
    start_jitter_s: float


class ControllerInstance(ABC):
    """A controller for one stop, created and not yet reset.

    Attributes:
        version: what it says of itself, empty if nothing.
        declares: the JSON in which it declares its parameters, empty if it does not.
        contract: version of the contract that it keeps.
        runs_beside_others: whether its step is machine code, and others of its kind may be open meanwhile.
        failed: whether its step has failed though it may not have said so.
        step_address: address of a function like `uictest_step`.
        handle: first argument of that function.
    """

    version: str = ""
    declares: str = ""
    contract: int = 1
    runs_beside_others: bool = False
    failed: bool = False
    step_address: int
    handle: int = 0

    @property
    def response_times(self) -> ResponseTimes | None:
        """How it answered in a stop that was paced by the clock, else None."""
        return None

    @abstractmethod
    def reset(self) -> None:
        """Return to the state after creation. Raises ControllerError."""

    def last_error(self) -> str:
        """Return the reason why the last step failed; empty if the controller gave none."""
        return ""

    def close(self) -> None:  # noqa: B027 - most have nothing to release
        """Release the controller; it is not called afterwards."""


class CallbackInstance(ControllerInstance):
    """A controller that compiled code calls through a callback; any exception in it ends the stop."""

    def __init__(self) -> None:
        self._callback = STEP(self._step)
        self.step_address = ctypes.cast(self._callback, ctypes.c_void_p).value or 0
        self._error = ""
        if sys.unraisablehook is not _note_lost:
            _other_hook[:] = [sys.unraisablehook]
            sys.unraisablehook = _note_lost

    def last_error(self) -> str:
        """Return the exception of the last step, in words."""
        return self._error

    @abstractmethod
    def answer(self, inputs: int, outputs: int) -> None:
        """Decide on the coming cycle: read the inputs at one address, write the outputs to the other."""

    def _step(self, handle: int | None, inputs: int, outputs: int) -> int:
        # An exception must not leave a callback: ctypes would tell the hook below and answer anything.
        try:
            if not self.failed:
                self.answer(inputs, outputs)
        except BaseException as error:
            self.note(error)
        return int(self.failed)

    def note(self, error: BaseException) -> None:
        """Keep why a step failed; no later one succeeds."""
        self.failed, self._error = True, f"{reason_of(error)}{_place_of(error)}"


_other_hook: Final = [sys.unraisablehook]


def _note_lost(lost: Any) -> None:
    """Let a controller fail whose callback was left by an exception: a signal may come at its entry."""
    controller = getattr(lost.object, "__self__", None)
    if isinstance(controller, CallbackInstance):
        controller.note(lost.exc_value)
    else:
        _other_hook[0](lost)


class CalledInstance(CallbackInstance):
    """A controller whose step is a method."""

    @abstractmethod
    def step(self, inputs: Inputs) -> Outputs:
        """Decide on the coming cycle."""

    def answer(self, inputs: int, outputs: int) -> None:
        """Call the method."""
        answered = self.step(read_inputs(memory_at(inputs, INPUTS)))
        write_outputs(memory_at(outputs, OUTPUTS), answered, self.contract)


def reason_of(error: BaseException) -> str:
    """Return an exception in one line."""
    name = type(error).__name__
    try:
        text = str(error)
    except Exception:  # the text of an exception is foreign code as well
        return name
    if isinstance(error, ControllerError):
        return text
    return f"{name}: {text}" if text else name


def _place_of(error: BaseException) -> str:
    """Return the line of the controller's own code that an exception comes from."""
    if isinstance(error, ControllerError):
        return ""
    frames = traceback.extract_tb(error.__traceback__)
    foreign = [frame for frame in frames if not Path(frame.filename).is_relative_to(_PACKAGE)]
    return f" ({Path(foreign[-1].filename).name}, line {foreign[-1].lineno})" if foreign else ""


def _packing_of_fields(layout: Any, *names: str) -> Struct:
    """Return the packing of adjacent fields: whole numbers, floats, and arrays of them."""
    codes = {"i8": "q", "f8": "d", "i4": "i", "u4": "I"}
    kinds = [layout[name] for name in names]
    each = (f"{math.prod(kind.shape)}{codes[kind.base.kind + str(kind.base.itemsize)]}" for kind in kinds)
    return Struct("=" + "".join(each))


_INPUTS: Final = _packing_of_fields(INPUTS, *INPUTS.names or ())
_OUTPUTS: Final = _packing_of_fields(OUTPUTS, "reference_speed", "hold", "vent", "diagnosis")
_ADDED: Final = ("dynamic_reduction", "sand_request", "track_brake_request")
"""What version 2 has added to the outputs."""
_ADDED_OUTPUTS: Final = _packing_of_fields(OUTPUTS, *_ADDED)
_NONE: Final = (0,) * WHEELSETS
_STATES: Final[Any] = {states: states for states in product((0, 1), repeat=WHEELSETS)}


def memory_at(address: int, layout: Any) -> Any:
    """Return the bytes of a record that lies at an address, which can be written."""
    return (ctypes.c_char * layout.itemsize).from_address(address)


def read_inputs(memory: Any) -> Inputs:
    """Return inputs, the record or its bytes, as a Python controller sees them."""
    numbers = _INPUTS.unpack_from(memory)
    cycle, time = numbers[:2]
    demand, valid_1, valid_2, valid_3, valid_4 = numbers[10:15]
    load, command, train_speed, acceleration, has_speed, has_acceleration = numbers[19:]
    valid = valid_1 != 0, valid_2 != 0, valid_3 != 0, valid_4 != 0
    return Inputs(
        *(cycle, time, numbers[2:6], valid, numbers[6:10], demand, numbers[15:19], load, command),
        *(train_speed, has_speed != 0, acceleration, has_acceleration != 0),
    )


def checked_contract(version: Any, said: str) -> int:
    """Return a version of the contract. Raises ControllerError for an unknown one; `said` is who says it."""
    if type(version) is not int or version not in CONTRACTS:
        raise ControllerError(f"{said} {version!r}, expected {' or '.join(map(str, CONTRACTS))}")
    return version


def write_outputs(memory: Any, outputs: Outputs, contract: int) -> None:
    """Write the answer of a controller in Python into memory. Raises ControllerError where it is none.

    Whether reductions are within 0 to 1 is left to who reads them. Nothing is written where it raises.
    """
    try:
        hold, vent = outputs.hold, outputs.vent
        reference, diagnosis = outputs.reference_speed, outputs.diagnosis
    except AttributeError:
        raise ControllerError(f"step returned {type(outputs).__name__}, expected Outputs") from None
    magnets = *_magnets("hold", hold), *_magnets("vent", vent)
    answer = _number("reference_speed", math.nan if reference is None else reference), *magnets
    bits = _bits(diagnosis)
    added = [getattr(outputs, name, None) for name in _ADDED]
    if contract > 1:
        _ADDED_OUTPUTS.pack_into(memory, OUTPUT_BYTES[1], *_of_version_2(*added))
    elif any(value is not None for value in added):
        name = next(name for name, value in zip(_ADDED, added, strict=True) if value is not None)
        raise ControllerError(f"{name} belongs to contract version 2, and the controller is of version 1")
    _OUTPUTS.pack_into(memory, 0, *answer, bits)


def _of_version_2(reduction: Any, sand: Any, track_brake: Any) -> tuple[Any, ...]:
    shares = _four_values("dynamic_reduction", _NONE if reduction is None else reduction)
    return (
        *(_number(f"dynamic_reduction[{number}]", share) for number, share in enumerate(shares)),
        *_magnets("sand_request", _NONE if sand is None else sand),
        0 if track_brake is None else _bit("track_brake_request", track_brake),
    )


def _magnets(name: str, values: Any) -> tuple[int, ...]:
    listed = _four_values(name, values)
    with suppress(KeyError, TypeError):  # what is neither 0 nor 1, and what is no number at all
        return tuple(_STATES[listed])
    return tuple(_bit(f"{name}[{number}]", value) for number, value in enumerate(listed))


def _bit(name: str, value: Any) -> int:
    with suppress(TypeError, ValueError):  # an array is neither true nor false
        if value in (0, 1):
            return int(value)
    raise ControllerError(f"{name} is {value!r}, expected 0 or 1")


def _bits(diagnosis: Any) -> int:
    with suppress(TypeError):
        if 0 <= index(diagnosis) <= _LARGEST_DIAGNOSIS:
            return index(diagnosis)
    raise ControllerError(f"diagnosis is {diagnosis!r}, expected a whole number of 32 bits")


def _four_values(name: str, values: Any) -> tuple[Any, ...]:
    try:
        listed = tuple(values)
    except TypeError:
        raise ControllerError(f"{name} is {values!r}, expected {WHEELSETS} values") from None
    if len(listed) != WHEELSETS:
        raise ControllerError(f"{name} has {len(listed)} values, expected {WHEELSETS}")
    return listed


def _number(name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise ControllerError(f"{name} is {value!r}, expected a number") from None


class StatedDeclaration(NamedTuple):
    """A declaration that a program has stated itself."""

    default: Any = None
    unit: str = ""
    range: Sequence[float] | None = None
    description: str = ""


def reject_undeclared(program: ControllerProgram, stated: str | None) -> None:
    """Raise ControllerError where a program that runs is given what it does not declare.

    `stated` is the JSON in which it states its parameters, None where it states none.
    """
    mode, given = program.options.get("parameters"), json.loads(program.parameters)
    if stated is None:
        problems = [nothing_declared(given)] if mode == "asked" and given else []
    else:
        problems = [*parameter_problems(stated_declarations(stated), given, free=mode == "free")]
    if problems:
        raise ControllerError("; ".join(f"controller.parameters.{each.name}: {each}" for each in problems))


def stated_declarations(text: str) -> dict[str, StatedDeclaration]:
    """Return the declarations in the JSON of a program. Raises ControllerError where they are none."""
    try:
        stated = {
            str(name): StatedDeclaration(**declaration) for name, declaration in json.loads(text).items()
        }
        for name, declaration in stated.items():
            low, high = map(float, declaration.range or (0.0, 0.0))
            if not low <= high:
                raise ValueError(f"the range of {name} is {low:g} to {high:g}")
            defaults = {} if declaration.default is None else {name: declaration.default}
            for problem in parameter_problems({name: declaration}, defaults):
                raise ValueError(f"the default of {name}: {problem}")
        return stated
    except (ValueError, TypeError, AttributeError, RecursionError) as error:
        form = '{"NAME": {"default": 1.0, "unit": "s", "range": [0, 2]}}'
        reason = "nested too deeply" if isinstance(error, RecursionError) else error
        raise ControllerError(f"its parameters are not of the form {form}: {reason}") from None
