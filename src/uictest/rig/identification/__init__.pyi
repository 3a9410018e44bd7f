from .channels import (
    AS_BUILT as AS_BUILT,
    RecordedChannels as RecordedChannels,
    read_record as read_record,
    samples_digest as samples_digest,
)
from .compensation_file import (
    Provenance as Provenance,
    check_compensation as check_compensation,
    load_compensation as load_compensation,
    with_air as with_air,
    with_cylinder as with_cylinder,
    with_hysteresis as with_hysteresis,
)
from .cylinder import (
    CylinderResult as CylinderResult,
    fitted_freely as fitted_freely,
    identify_cylinder as identify_cylinder,
    require_fit as require_fit,
)
from .hysteresis import (
    HysteresisResult as HysteresisResult,
    identify_hysteresis as identify_hysteresis,
    require_force_fit as require_force_fit,
)
from .lines import (
    on_lines as on_lines,
    wsp_acting_from_commands as wsp_acting_from_commands,
    wsp_acting_in_intervals as wsp_acting_in_intervals,
)
from .result_text import (
    AirResult as AirResult,
    air_text as air_text,
    cylinder_text as cylinder_text,
    hysteresis_text as hysteresis_text,
    is_of_one_rig as is_of_one_rig,
)
from .suitability import (
    UnsuitableRecordError as UnsuitableRecordError,
    held_out as held_out,
    required_sampling_time as required_sampling_time,
)
from .transfer_function import TransferFunction as TransferFunction
