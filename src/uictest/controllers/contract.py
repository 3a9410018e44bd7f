"""Types of what a controller is given.

They are records whose fields are read and written as attributes, in plain Python and in compiled code
alike; the fields depend on the controllers and are listed in :mod:`uictest.rig.model.records`.
"""

from collections.abc import Sequence
from typing import Any

Record = Any
Car = Record
Wheelset = Record
Wheelsets = Sequence[Record]
Parameters = Record
