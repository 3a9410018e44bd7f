"""The code of the rig for one stop at a time: to standstill, or one controller cycle after the other."""

from typing import Any, Final

from uictest.controllers import EXCHANGE
from uictest.core import lanes
from uictest.core.lanes import translate
from uictest.core.measures import FAULT_COLUMNS, STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.compiled import compile_inner, scalar_model
from uictest.rig.backends.machine_code import Entries, Unit
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS

RUN: Final = "uictest_run_stop"
"""Name of the function that runs a stop to standstill."""
RUN_ARGUMENTS: Final = (
    *(CAR, BOGIE, WHEELSET, PARAMETERS, WHEELSET_PARAMETERS, "f8", int, RAIL_MEMORY),
    *(STOP_MEASURES, WHEELSET_MEASURES, TRAIN_SAMPLE, WHEELSET_SAMPLE, int, int),
)
"""Its arguments: addresses of records and tables, and the lengths behind them."""
STEP: Final = "uictest_step_stop"
"""Name of the function that carries a stop on by one cycle."""
STEP_ARGUMENTS: Final = (
    *(CAR, BOGIE, WHEELSET, PARAMETERS, RAIL_MEMORY, STOP_MEASURES, WHEELSET_MEASURES, EXCHANGE),
    *(TRAIN_SAMPLE, WHEELSET_SAMPLE),
    *(WHEELSET_PARAMETERS, "f8", int, TRAIN_SAMPLE, WHEELSET_SAMPLE, int, int, int),
)
"""Its arguments likewise: addresses of the parts of :data:`~uictest.rig.backends.stepped.STOP_MEMORY`, of the
wheelsets' parameters and of the rail, points of the rail, addresses of a trace, rows that it has room for,
steps per sample, rows that are filled. It returns the rows filled afterwards."""
NOTE: Final = "uictest_note_samples"
"""Name of the function that feeds a recording to the measures; it is in one object file with the stop."""
NOTE_ARGUMENTS: Final = (
    *(STOP_MEASURES, WHEELSET_MEASURES, PARAMETERS, "f8", int, "f8", "f8", int, "f8", int, "i8", int, "f8"),
)
"""Its arguments: addresses of records and tables, each table that may be of any length followed by that."""


def _entries() -> Entries:
    """Return the functions, of addresses and the lengths behind them."""
    from uictest.core.measures import note_samples
    from uictest.rig.model.stop import run_stop, step_stop  # a warm start does not load what it would compile

    run, step, note = (
        translate(function, compile_inner, scalar_model()) for function in (run_stop, step_stop, note_samples)
    )
    return {
        RUN: (_run_on_addresses(run), RUN_ARGUMENTS),
        STEP: (_step_on_addresses(step), STEP_ARGUMENTS),
        NOTE: (_note_on_addresses(note), NOTE_ARGUMENTS),
    }


def _run_on_addresses(entry: Any) -> Any:
    carray = lanes.carray

    def on_addresses(
        car: Any,
        bogies: Any,
        wheelsets: Any,
        p: Any,
        wheelset_parameters: Any,
        rail: Any,
        points: int,
        memory: Any,
        measures: Any,
        wheelset_measures: Any,
        train_samples: Any,
        wheelset_samples: Any,
        rows: int,
        steps_per_sample: int,
    ) -> Any:
        return entry(
            carray(car, 1)[0],
            carray(bogies, 2),
            carray(wheelsets, 4),
            carray(p, 1)[0],
            carray(wheelset_parameters, 4),
            carray(rail, (ROWS, points)),
            carray(memory, 1)[0],
            carray(measures, 1)[0],
            carray(wheelset_measures, 4),
            Trace(carray(train_samples, rows), carray(wheelset_samples, (rows, 4))),
            steps_per_sample,
        )

    return on_addresses


def _step_on_addresses(entry: Any) -> Any:
    carray = lanes.carray

    def on_addresses(
        car: Any,
        bogies: Any,
        wheelsets: Any,
        p: Any,
        memory: Any,
        measures: Any,
        wheelset_measures: Any,
        exchange: Any,
        present_train: Any,
        present_wheelsets: Any,
        wheelset_parameters: Any,
        rail: Any,
        points: int,
        train_samples: Any,
        wheelset_samples: Any,
        room: int,
        steps_per_sample: int,
        rows: int,
    ) -> Any:
        return entry(
            carray(car, 1)[0],
            carray(bogies, 2),
            carray(wheelsets, 4),
            carray(p, 1)[0],
            carray(wheelset_parameters, 4),
            carray(rail, (ROWS, points)),
            carray(memory, 1)[0],
            carray(measures, 1)[0],
            carray(wheelset_measures, 4),
            carray(exchange, 1)[0],
            Trace(carray(present_train, 1), carray(present_wheelsets, (1, 4))),
            Trace(carray(train_samples, room), carray(wheelset_samples, (room, 4))),
            steps_per_sample,
            rows,
        )

    return on_addresses


def _note_on_addresses(entry: Any) -> Any:
    carray = lanes.carray

    def on_addresses(
        measures: Any,
        wheelset_measures: Any,
        definition: Any,
        samples: Any,
        rows: int,
        wheelset_samples: Any,
        faults: Any,
        rows_with_faults: int,
        numbers: Any,
        size: int,
        places: Any,
        noted_numbers: int,
        noted: Any,
    ) -> Any:
        return entry(
            carray(measures, 1)[0],
            carray(wheelset_measures, 4),
            carray(definition, 1)[0],
            carray(samples, (rows, 8)),
            carray(wheelset_samples, (rows, 4, 10)),
            carray(faults, (rows_with_faults, FAULT_COLUMNS)),
            carray(numbers, size),
            carray(places, noted_numbers),
            carray(noted, (rows - 1, noted_numbers)),
        )

    return on_addresses


SCALAR = Unit(
    "uictest_scalar",
    {RUN: "the rig for single stops", STEP: "the rig for stops in steps"},
    _entries,
    {RUN: (NOTE,)},
)
