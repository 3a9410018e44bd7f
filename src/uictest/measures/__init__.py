"""Streaming measures of a stop: what is kept of every sample.

The simulator updates them once per controller cycle while it steps, an evaluation of a recording once
per row, with the same functions: a simulated and a measured stop are judged by the same code. Scalar
code on records, importing nothing of the package but its arithmetic.
"""

from uictest.measures.records import DEFINITION, MEASURES, SPEED_CLASSES, WHEELSET_MEASURES, WINDOW_SECONDS
from uictest.measures.train import begin, finish, observe_train
from uictest.measures.wheelset import begin_wheelset, observe_wheelset

__all__ = [
    "DEFINITION",
    "MEASURES",
    "SPEED_CLASSES",
    "WHEELSET_MEASURES",
    "WINDOW_SECONDS",
    "begin",
    "begin_wheelset",
    "finish",
    "observe_train",
    "observe_wheelset",
]
