"""Fitting a scenario to a recorded stop: the friction of its rail, and of its brake pads.

The speed of a train under WSP depends chaotically on friction: a cycle more or less moves everything after
it. So no simulated stop is compared here. Balances of momentum are drawn over short windows with the
*recorded* slip speeds in the creep law, which leaves a smooth problem of a few unknowns; the simulation only
confirms the result.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
