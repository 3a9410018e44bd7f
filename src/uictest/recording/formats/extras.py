"""Libraries that only some formats need: imported when they are, installed by those who want them."""

from __future__ import annotations

import importlib
from typing import Any

from uictest.recording.formats.problems import MissingExtraError


def required(module: str, extra: str) -> Any:
    """Return a module. Raises MissingExtraError with the line that installs it, as `uictest[extra]`."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != module.partition(".")[0]:
            raise
        raise MissingExtraError(f"{module} is not installed: pip install 'uictest[{extra}]'") from error
