from .selection import (
    ALGORITHMS as ALGORITHMS,
    CAR_MEMORY as CAR_MEMORY,
    WHEELSET_MEMORY as WHEELSET_MEMORY,
    begin as begin,
    decide as decide,
    reference_speed as reference_speed,
)
