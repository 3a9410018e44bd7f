from .arguments import (
    Arguments as Arguments,
    Length as Length,
    at as at,
    leaves as leaves,
    lengths as lengths,
    passed as passed,
)
from .block import block as block, fuses as fuses, register_width as register_width
from .functions import (
    align_stack as align_stack,
    call as call,
    floor as floor,
    fma as fma,
    maximum as maximum,
    minimum as minimum,
    record_at as record_at,
    select as select,
    sqrt as sqrt,
)
from .linked import bitcode as bitcode, compile_inner as compile_inner
from .records import (
    copy_from_lane as copy_from_lane,
    copy_to_lane as copy_to_lane,
    lane as lane,
    vectors as vectors,
)
from .translation import translate as translate
