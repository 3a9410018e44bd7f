"""What the lanes are given: blocks in which stops run side by side, and the cases that wait for them."""

from typing import Any, NamedTuple


class RigRecords(NamedTuple):
    """Records of one rig, or blocks of them in lanes: a car, two bogies, four wheelsets."""

    car: Any
    bogies: Any
    wheelsets: Any


class Lanes(NamedTuple):
    """Blocks of lanes (:func:`uictest.core.lanes.block`): a rig, its parameters, the measures of its stop."""

    rig: RigRecords
    settings: Any
    measures: Any
    wheelset_measures: Any
    module_steps: Any


class Cases(NamedTuple):
    """Inputs of stops and the records that receive their measures, an entry for each case."""

    parameters: Any
    wheelset_parameters: Any
    rail: Any
    measures: Any
    wheelset_measures: Any


class Trains(NamedTuple):
    """Inputs of trains of n cars and the records that receive their measures, an entry for each train.

    Car by car, so that the entries of one car are cases: parameters and measures of shape (n, trains), those
    of wheelsets (n, trains, 4), distances (n, trains). The rail is one for all cars, the couplers of a train
    lie together: (trains, n - 1).
    """

    parameters: Any
    wheelset_parameters: Any
    rail: Any
    distances: Any
    couplers: Any
    measures: Any
    wheelset_measures: Any
