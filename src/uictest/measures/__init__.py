"""Streaming measures of a stop: what is kept of every sample.

The simulator updates them once per controller cycle while it steps, an evaluation of a recording once
per row, with the same functions: a simulated and a measured stop are judged by the same code. Scalar
code on records, importing nothing of the package but its arithmetic.

What is one number is taken in without branches, so that many stops can be observed side by side; what is
a table - speeds after the first sliding, slides above each speed - is kept from that afterwards.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
