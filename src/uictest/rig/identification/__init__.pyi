from .compensation_file import (
    Provenance as Provenance,
    check_compensation as check_compensation,
    is_of_one_rig as is_of_one_rig,
    load_compensation as load_compensation,
    with_air as with_air,
    with_cylinder as with_cylinder,
    with_hysteresis as with_hysteresis,
)
from .cylinder import (
    AirResult as AirResult,
    CylinderResult as CylinderResult,
    TransferFunction as TransferFunction,
    air_text as air_text,
    cylinder_text as cylinder_text,
    fitted_freely as fitted_freely,
    identify_cylinder as identify_cylinder,
    require_fit as require_fit,
)
from .hysteresis import (
    HysteresisResult as HysteresisResult,
    all_four as all_four,
    hysteresis_text as hysteresis_text,
    identify_hysteresis as identify_hysteresis,
    require_force_fit as require_force_fit,
)
from .lines import (
    FittedLine as FittedLine,
    computed_force as computed_force,
    on_lines as on_lines,
    wsp_acting_from_commands as wsp_acting_from_commands,
    wsp_acting_in_intervals as wsp_acting_in_intervals,
)
from .record import (
    AS_BUILT as AS_BUILT,
    RecordedChannels as RecordedChannels,
    UnsuitableRecordError as UnsuitableRecordError,
    distrust as distrust,
    held_out as held_out,
    read_record as read_record,
    required_sampling_time as required_sampling_time,
    samples_digest as samples_digest,
)
