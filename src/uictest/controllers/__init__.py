"""Wheel-slide-protection controllers and the contract that each of them keeps.

Once per controller cycle the rig reads its speed sensors into ``wheelset.measured_speed`` (m/s) and
calls the controller. A controller is a module with these names:

``WHEELSET_MEMORY`` and ``CAR_MEMORY``
    What it remembers between cycles: pairs of field and kind (``"f8"`` or ``"i8"``) that become fields of
    the wheelset and of the car record.
``begin(car, wheelsets, speed)``
    Sets that memory at the start of a stop from ``speed`` m/s.
``decide(car, wheelsets, parameters)``
    Sets ``wheelset.command`` of each of the four wheelsets to FILL, HOLD or VENT
    (:mod:`uictest.physics.wsp_valve`). It sees ``measured_speed``, its own memory and the parameters of its
    own model in ``scenario.parts.controller``, and nothing else of the rig.

It is scalar code without allocation, may branch, and counts time in its own cycles. A new one is a
module here, a model there and a line in :mod:`uictest.controllers.selection`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
