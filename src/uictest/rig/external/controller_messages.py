"""Controllers from outside and records in messages."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from uictest.controllers import Config, ControllerProgram


def written_controllers(
    programs: Sequence[ControllerProgram | None], configs: Sequence[Config | None]
) -> list[dict[str, Any]]:
    """Return programs and what each is given before a stop, in the form of JSON."""
    return [
        {"program": asdict(program), "config": asdict(config)}
        for program, config in zip(programs, configs, strict=True)
        if program is not None and config is not None
    ]


def read_controller(form: dict[str, Any]) -> tuple[ControllerProgram, Config]:
    """Return one of them."""
    config = form["config"] | {"wheel_radius": tuple(form["config"]["wheel_radius"])}
    return ControllerProgram(**form["program"]), Config(**config)


def bytes_of(records: Sequence[Any]) -> tuple[bytes, ...]:
    """Return the bytes of records or arrays."""
    return tuple(np.ascontiguousarray(each).tobytes() for each in records)
