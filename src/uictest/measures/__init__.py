"""Streaming measures of a stop: what is kept of every sample.

The simulator updates them once per controller cycle while it steps, an evaluation of a recording once
per row, with the same functions: a simulated and a measured stop are judged by the same code. Scalar
code on records, importing nothing of the package but its arithmetic.

What is one number is taken in without branches, so that many stops can be observed side by side; what is
a table - speeds after the first sliding, slides above each speed - is kept from that afterwards.
"""

from uictest.measures.records import DEFINITION, MEASURES, SPEED_CLASSES, WHEELSET_MEASURES, WINDOW_SECONDS
from uictest.measures.train import begin, begin_window, finish, keep_window, observe_train
from uictest.measures.wheelset import begin_slides, begin_wheelset, keep_slide, observe_wheelset

__all__ = [
    "DEFINITION",
    "MEASURES",
    "SPEED_CLASSES",
    "WHEELSET_MEASURES",
    "WINDOW_SECONDS",
    "begin",
    "begin_slides",
    "begin_wheelset",
    "begin_window",
    "finish",
    "keep_slide",
    "keep_window",
    "observe_train",
    "observe_wheelset",
]
