"""Builds the libraries of FMUs, one for each system, which `python kernel/build.py --fmus` does.

A library is the same in every FMU: the code of the stepped rig and of the built-in controllers, and the
functions of FMI (kernel/fmi), which read what an FMU is of from a file beside it.
"""

import tempfile
from functools import cache
from pathlib import Path
from typing import Final

from kernel.build import PROCESSOR, TARGETS, Target, compile_files, flags_of, put_library
from kernel.contents import RECORDS, written
from kernel.records import struct
from uictest import controllers
from uictest.api.fmu import resource
from uictest.api.fmu.building import FOLDER, SYSTEMS
from uictest.rig.kernel.arguments import leaves, lengths
from uictest.rig.kernel.library import Entry, source_digest
from uictest.rig.model.controller import ALONE
from uictest.rig.train_stop import STEP

CALLED: Final = {"step_rig": ("RIG_ARGUMENTS", STEP), "decide_alone": ("CONTROLLER_ARGUMENTS", ALONE)}
"""What kernel/fmi calls -> its name for the number of arguments, and the function."""
_LEVELS: Final = ("v1", "v3")
"""Of the processor, that there is code for: one stop at a time gains nothing from wider registers."""
_FAILURES: Final = ("NO_FAILURE", "FORBIDDEN_COMMAND", "NO_REDUCTION")
_FLAGS: Final = (
    *("-std=c++20", "-O2", "-Wall", "-Wextra", "-ffp-contract=off", "-fno-exceptions", "-fno-rtti"),
    # The memory of an instance is read as numbers and as records of numbers.
    *("-fno-strict-aliasing", "-fvisibility=hidden", "-fPIC"),
)


def build_libraries(folder: Path = FOLDER) -> list[Path]:
    """Build the library of every system into a folder; those before go.

    Raises BuildError, UntranslatableError.
    """
    # They open files and other libraries: unlike the kernel they need the C library.
    targets = {system: TARGETS[system]._replace(link=()) for system in SYSTEMS}
    return [put_library(each, objects_for(each), folder, f"fmu-{system}") for system, each in targets.items()]


def objects_for(target: Target) -> list[Path]:
    """Return the object files of a library. Raises BuildError, UntranslatableError."""
    hidden = "-DEXPORT="
    processor, flags = PROCESSOR
    with tempfile.TemporaryDirectory() as temporary:
        model, functions = (Path(temporary) / name for name in ("model.cpp", "functions.cpp"))
        model.write_text(_model(), encoding="utf-8", newline="\n")
        functions.write_text(_functions(), encoding="utf-8", newline="\n")
        levels = [level for level in _LEVELS if level in target.levels]
        work = [*((model, (*flags_of(target, level), hidden)) for level in levels)]
        return compile_files(target, [*work, (processor, (*flags, hidden)), (functions, _FLAGS)])


@cache
def _model() -> str:
    return written([entry for _, entry in CALLED.values()]).text()


def _functions() -> str:
    """Return the C++ of the functions of FMI, behind the layouts of what they read and what they call."""
    values = {name: getattr(controllers, name) for name in _FAILURES}
    for name, words in resource.ENUMERATIONS.items():
        values |= {f"{name}_{word.upper()}": number for number, word in enumerate(words)}
    records = {**resource.LAYOUTS, "Exchange": RECORDS["Exchange"]}
    return "".join(
        (
            "#define UICTEST_ABI_VERSION 2\n",
            controllers.HEADER.read_text("utf-8"),
            '#include <stddef.h>\nextern "C" int uictest_processor(void);\nnamespace {\n',
            *(f"constexpr int64_t {name} = {value};\n" for name, value in values.items()),
            *(struct(name, layout) for name, layout in records.items()),
            f'constexpr char MAGIC[] = "{resource.MAGIC}", CODE[16] = "{source_digest()}";\n',
            "const int PROCESSOR = uictest_processor();\n}\n",
            *(_call(name, count, entry) for name, (count, entry) in CALLED.items()),
            '#include "fmi/functions.hpp"\n',
        )
    )


def _call(name: str, count: str, entry: Entry) -> str:
    """Return a function that calls the code for this processor with numbers and addresses in an array."""
    number = len(lengths(entry.arguments)) + sum(1 for _ in leaves(entry.arguments))
    types, given = (", ".join(each.format(n) for n in range(number)) for each in ("int64_t", "given[{}]"))
    v1, v3 = (f"{entry.symbol}_{level}" for level in _LEVELS)
    newer = "#ifdef __x86_64__\n{}\n#endif\n"
    return (
        f'extern "C" int64_t {v1}({types});\n'
        + newer.format(f'extern "C" int64_t {v3}({types});')
        + f"namespace {{\nconstexpr int64_t {count} = {number};\nint64_t {name}(const int64_t* given) {{\n"
        + newer.format(f"    if (PROCESSOR >= 3) return {v3}({given});")
        + f"    return {v1}({given});\n}}\n}}\n"
    )
