"""Measures: the numbers that describe a stop.

`catalogue` declares and finds every measure, one row each; all other rooms read it.

`samples` has the order in which a sample updates the records: the simulator feeds one per controller cycle,
the evaluation of a recording one per row. The same functions observe simulated and recorded stops. They are
scalar code on records. Single numbers are updated without branches, so that many stops can be observed side
by side; tables (speeds after the first sliding, slides above each speed) are updated afterwards.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
