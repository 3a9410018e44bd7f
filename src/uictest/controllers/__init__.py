"""Wheel-slide-protection controllers and the contract that each of them keeps.

Once per controller cycle the rig reads its speed sensors into ``wheelset.measured_speed`` (m/s) and
``wheelset.speed_valid`` (0 where a sensor reports a fault) and calls the controller, which sets
``wheelset.valve_command`` of each of the four wheelsets to FILL, HOLD or VENT
(:mod:`uictest.core.physics.air`). A controller sees these two, its own memory and its own parameters,
and nothing else of the rig.

A built-in controller is one module in :mod:`uictest.controllers.built_in`, found there without a further
edit. It declares a :class:`Controller`: name, parameters, memory, what sets the memory at the start of a stop
(``begin``) and what decides (``decide``). Both functions are scalar code without allocation, may branch, and
count time in controller cycles. Controllers that declare the same field share it in the records: only one of
them runs in a stop.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
