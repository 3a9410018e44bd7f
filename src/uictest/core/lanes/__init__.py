"""Lanes: one compiled function steps as many scenarios at once as a SIMD register holds numbers.

Compiled code that is given :func:`vectors` of a block of records reads and writes a whole register where it
names an attribute, and computes with ordinary operators and the functions below. Given one :func:`lane` of
the same block it reads and writes plain numbers: what branches runs lane by lane, what does not runs in all
lanes at once. Every operation rounds as its scalar counterpart does: a lane gives the bits that scalar code
gives, whatever its neighbours hold and however wide the register is.

The room depends on internals of numba; no other room does. It does not import the rig. What only compiled
code calls is imported when it is first used, since blocks are filled without a compiler; import it by name:
numba does not find functions that appear while it compiles.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
