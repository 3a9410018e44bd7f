"""The stop in plain Python: slow, with the bits of compiled code, for tests and debuggers."""

from functools import cache
from typing import Any

from uictest.controllers import Controller
from uictest.rig.backends.compiled import translate, with_controller
from uictest.rig.model.stop import run_stop


@cache
def plain_stop(controller: Controller) -> Any:
    """Return :func:`uictest.rig.model.stop.run_stop` for a controller, as the interpreter runs it."""
    return translate(
        run_stop, lambda function: function, with_controller(controller, lambda function: function, {})
    )
