"""Controllers as FMUs: co-simulation, FMI 2.0 or 3.0, through FMPy.

In every controller cycle the inputs are set, the FMU makes one step of one cycle, and its outputs are read:
the answer belongs to the inputs of the same cycle. An FMU may answer a cycle late, where its tool evaluates
inputs at the start of the next step: that is a property of the FMU, and the stop shows it.
"""

import sys
from contextlib import redirect_stdout
from importlib.util import find_spec

from uictest.controllers.adapters.errors import ControllerError
from uictest.controllers.adapters.instance import ControllerInstance
from uictest.controllers.declared import ControllerProgram
from uictest.controllers.interface import Config


def open_controller(program: ControllerProgram, config: Config) -> ControllerInstance:
    """Take the FMU of this file, loaded once per thread. Raises ControllerError."""
    if find_spec("fmpy") is None:
        raise ControllerError("controllers as FMUs need FMPy: pip install 'uictest[fmu]'")
    # FMPy is an extra. It prints where a part of it does not load; standard output is for results.
    with redirect_stdout(sys.stderr):
        from uictest.controllers.adapters.fmu.instance import open_fmu
    return open_fmu(program, config)
