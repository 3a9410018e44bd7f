"""What the description of an FMU states, read in a process of its own with bounded time and memory.

`python -m uictest.plans.scenario.fmu_description PATH` writes it to standard output.
"""

import json
import math
import subprocess
import sys
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.core import files
from uictest.core.guarded_process import bound_resources, reading_process

LARGEST_DESCRIPTION: Final = 64 * 2**20
"""Bytes of a description that are read, and of what is told of it; chosen: large models have some ten MiB."""
_SECONDS: Final = 60.0
"""Time after which reading is aborted; chosen: some ten megabytes take a second."""
_MEMORY: Final = 4 * 2**30
"""Address space of the process that reads, bytes; chosen: the largest description takes half of it."""


class FmuDescription(NamedTuple):
    """The version that an FMU states, and how it declares its parameters; None where it cannot be read."""

    version: str = ""
    parameters: Mapping[str, Mapping[str, Any]] | None = None


def read_description(path: Path) -> FmuDescription:
    """Return the description of an FMU; empty if it is unreadable, which loading reports. Raises OSError."""
    with (
        files.temporary_folder() as folder,
        reading_process(__name__, [str(path.absolute())], folder) as process,
        suppress(subprocess.TimeoutExpired),
    ):
        answer, _ = process.communicate(timeout=_SECONDS)
        if process.returncode == 0:
            return FmuDescription(*json.loads(answer))
    return FmuDescription()


def _description_in(path: Path) -> FmuDescription:
    from xml.etree import ElementTree  # which the process that asks does without

    with zipfile.ZipFile(path) as archive:
        if archive.getinfo("modelDescription.xml").file_size > LARGEST_DESCRIPTION:
            raise ValueError("the description is too large")
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    types = {str(element.get("name")): element for element in root.iterfind("TypeDefinitions/*")}
    parameters = {
        str(variable.get("name")): _declared_parameter(variable, types)
        for variable in root.iterfind("ModelVariables/*")
        if variable.get("causality") == "parameter"
    }
    return FmuDescription(root.get("version", ""), parameters)


def _declared_parameter(variable: Any, types: Mapping[str, Any]) -> dict[str, Any]:
    """Return one parameter. Its type is an inner element in FMI 2.0, the name of the element in FMI 3.0."""
    typed = next(iter(variable), variable) if variable.tag == "ScalarVariable" else variable
    declared = types.get(typed.get("declaredType", ""))
    attributes: dict[str, str] = {}
    for element in (*([] if declared is None else (declared, *declared)), typed):
        attributes.update(element.attrib)
    default: Any = attributes.get("start")
    bounds: list[float] = []
    if typed.tag == "Boolean":
        default = None if default is None else default in ("true", "1")
    elif typed.tag != "String":
        default = next(_parsed_numbers([default or ""]), None)
        bounds = [*_parsed_numbers([attributes.get("min", "-inf"), attributes.get("max", "inf")])]
    return {
        "default": default,
        "unit": attributes.get("unit", ""),
        "range": bounds if len(bounds) > 1 and bounds != [-math.inf, math.inf] else None,
        "description": variable.get("description", ""),
    }


def _parsed_numbers(texts: Iterable[str]) -> Iterator[float]:
    """Yield the numbers among texts, without NaN and without arrays, whose start value is several numbers."""
    for text in texts:
        with suppress(ValueError):
            if not math.isnan(number := float(text)):
                yield number


if __name__ == "__main__":
    bound_resources(_MEMORY, _SECONDS)
    text = json.dumps(_description_in(Path(sys.argv[1])))
    if len(text) > LARGEST_DESCRIPTION:
        raise ValueError("what it states is too large")
    sys.stdout.write(text)
