from .space import (
    NOMINAL as NOMINAL,
    Axis as Axis,
    FaultAxes as FaultAxes,
    Point as Point,
    Space as Space,
    load_search as load_search,
    searches_in as searches_in,
)
