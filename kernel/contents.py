"""What the kernel holds: records, the functions that Python calls, what the runtime header replaces."""

import inspect
from collections.abc import Iterable, Mapping
from typing import Any, Final

from kernel.cpp import Program
from kernel.names import safe
from kernel.records import lane_struct, struct
from uictest.controllers import EXCHANGE, OUTPUTS_AT
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.core.physics import arithmetic
from uictest.rig import lanes, recorded_stop, reference_distance, train_stop
from uictest.rig.bench import identified_air, run as bench
from uictest.rig.bench.run import BENCH_SAMPLE
from uictest.rig.kernel import arguments as lane_functions
from uictest.rig.kernel.arguments import Length, block_layout, lengths
from uictest.rig.kernel.library import BUILDER, WIDTHS, Entry
from uictest.rig.model import controller, rail, stop, stop_measures, trace
from uictest.rig.model.parameters import PARAMETERS, WHEELSET_PARAMETERS
from uictest.rig.model.state import BOGIE, CAR, COUPLER, MODULE_STEP, WHEELSET

RECORDS: Final = {
    "Car": CAR,
    "Bogie": BOGIE,
    "Wheelset": WHEELSET,
    "Parameters": PARAMETERS,
    "Coupler": COUPLER,
    "StopMeasures": STOP_MEASURES,
    "WheelsetMeasures": WHEELSET_MEASURES,
    "ModuleStep": MODULE_STEP,
    "WheelsetParameters": WHEELSET_PARAMETERS,
    "RailMemory": rail.RAIL_MEMORY,
    "Exchange": EXCHANGE,
    "TrainSample": trace.TRAIN_SAMPLE,
    "WheelsetSample": trace.WHEELSET_SAMPLE,
    "BenchSample": BENCH_SAMPLE,
    "RecordedMotion": rail.RECORDED_MOTION,
    "MetRail": rail.MET_RAIL,
}
"""Records by their names in C++; the first eight also lie in lanes."""
_IN_LANES: Final = tuple(RECORDS)[:8]
_WIDTH: Final = max(WIDTHS.values())
"""Lanes by which the layouts of blocks are found here; in the generated code each variant has its own."""
ENTRIES: Final = (
    *(train_stop.RUN, train_stop.STEP, lanes.entry(_WIDTH), recorded_stop.NOTE),
    *(recorded_stop.FOLLOW, reference_distance.ENTRY, bench.BENCH, identified_air.WALK),
)
_CALLS: Final = f"""
INLINE Exchange* exchange_at(int64_t address) {{ return (Exchange*)address; }}
INLINE int64_t call_step(int64_t step, int64_t handle, int64_t exchange) {{
    return call_step_at(step, (void*)handle, (void*)exchange, (void*)(exchange + {OUTPUTS_AT}));
}}
"""
_FUSED: Final = """
INLINE auto fused(auto a, auto b, auto c) {
#if defined(__FMA__) || defined(__aarch64__)
    if constexpr (in_lanes<decltype(a)> || in_lanes<decltype(b)> || in_lanes<decltype(c)>)
        return __builtin_elementwise_fma(spread(a), spread(b), spread(c));
    else return __builtin_fma((double)a, (double)b, (double)c);
#else
    return physics_arithmetic::fma(a, b, c);
#endif
}
"""
_IN_HEADER: Final = {
    **{getattr(arithmetic, name): name for name in ("select", "minimum", "maximum", "sqrt", "floor")},
    **{getattr(lane_functions, name): name for name in ("vectors", "lane", "copy_to_lane", "copy_from_lane")},
    controller.exchange_at: "exchange_at",
    controller.call_step: "call_step",
}
_OUTLINED: Final = (
    *(stop.start, stop_measures.begin_stop_measures, stop_measures.close_stop_measures, trace.sample),
    *(stop.forget, stop.notice_faults, stop.meet_rail, stop.take_commands, stop.set_demands),
    *(stop.keep_measures, controller.decide, controller.write_inputs, controller.read_outputs),
    arithmetic.fma,
)
"""Functions of a controller cycle or of a whole stop: copied into every caller they would double the code."""


def begun() -> Program:
    """Return what all generated code rests on."""
    program = Program(BUILDER.parent, _IN_HEADER, _OUTLINED)
    program.add('#include "runtime.hpp"\nnamespace {\n')
    program.function(arithmetic.fma)
    program.add(_FUSED)
    program.replaced[arithmetic.fma] = "fused"
    return program


def written(entries: Iterable[Entry] = ENTRIES) -> Program:
    """Return the kernel as C++, with all functions that Python calls or some. Raises UntranslatableError."""
    program = begun()
    for name, layout in RECORDS.items():
        program.add(struct(name, layout))
    program.add(_CALLS)
    for name in _IN_LANES:
        program.add(lane_struct(name, RECORDS[name]))
    for entry in entries:
        program.add(exported(program, entry, _C_TYPES))
    program.add("}\n")
    return program


def exported(program: Program, entry: Entry, types: Mapping[Any, str]) -> str:
    """Return the C function of an entry; it takes what `passed` gives.

    Args:
        program: where the function is written.
        entry: what it takes.
        types: names in C++ of the layouts of its records.
    """
    function = entry.target()
    head = [f"int64_t {_length_name(name)}" for name in lengths(entry.arguments)]
    names = inspect.signature(function).parameters
    given = [_given(program, *pair, types, head) for pair in zip(entry.arguments, names, strict=True)]
    call = f"{program.function(function)}({', '.join(given)})"
    returns = function.__annotations__.get("return") not in (None, "None")
    body = f"return {call};" if returns else f"{call};\n    return 0;"
    return f'extern "C" EXPORT int64_t OF_VARIANT({entry.symbol})({", ".join(head)}) {{\n    {body}\n}}\n'


def _given(program: Program, argument: Any, name: str, types: Mapping[Any, str], head: list[str]) -> str:
    """Return what the function is given for an argument, and add to the head what C gives for it."""
    if isinstance(argument, tuple):
        fields: Any = argument
        members = zip(argument, fields._fields, strict=True)
        inner = ", ".join(_given(program, each, f"{name}_{field}", types, head) for each, field in members)
        return f"{program.named_tuple(type(argument))}{{{inner}}}"
    if argument is int:
        head.append(f"int64_t {name}")
        return name
    kind = types.get(argument.layout) or {"f": "double", "i": "int64_t"}[argument.layout.kind]
    # Vectors alias everything in clang, and blocks of lanes never overlap; of other records the types tell.
    head.append(f"{kind}* {'__restrict ' if kind.endswith('Whole>') else ''}{name}_at")
    if not argument.shape:
        return f"{name}_at"
    sizes = ", ".join(map(_size, argument.shape))
    return f"Array<{kind}, {len(argument.shape)}>{{{name}_at, {{{sizes}}}}}"


_C_TYPES: Final = {
    **{layout: name for name, layout in RECORDS.items()},
    **{block_layout(RECORDS[name], _WIDTH): f"{name}Lanes<Vector, Whole>" for name in _IN_LANES},
}


def _length_name(name: str) -> str:
    return safe(name.replace(" ", "_"))


def _size(size: int | Length) -> str:
    if isinstance(size, int):
        return str(size)
    factor = f"{size.factor} * " if size.factor != 1 else ""
    return f"{factor}{_length_name(size.name)}{f' - {size.less}' if size.less else ''}"
