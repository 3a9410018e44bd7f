"""Faults of the brake and its controller that a scenario can inject.

:mod:`uictest.plans.faults.catalogue` declares every kind in one row: its part, its value and its effects. A
scenario reads the rows to check what a user writes, the rig to compute what a fault changes.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
