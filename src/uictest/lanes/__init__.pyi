from .block import block as block
from .functions import (
    floor as floor,
    fma as fma,
    maximum as maximum,
    minimum as minimum,
    select as select,
    sqrt as sqrt,
)
from .host import fuses as fuses, register_width as register_width
from .records import lane as lane, put as put, take as take, vectors as vectors
from .stack import align_stack as align_stack
