"""The stop in plain Python: slow, with the bits of compiled code, for tests and debuggers."""

from collections.abc import Sequence
from typing import Any

from uictest.controllers import Controller
from uictest.core.lanes import translate
from uictest.rig.backends.compiled import with_controllers
from uictest.rig.model.controller import CHOICES
from uictest.rig.model.stop import run_stop


def plain_stop(choices: Sequence[Controller] = CHOICES) -> Any:
    """Return :func:`uictest.rig.model.stop.run_stop`, with these controllers, as the interpreter runs it."""
    return translate(run_stop, _unchanged, with_controllers(choices, _unchanged, {}))


def _unchanged(function: Any) -> Any:
    return function
