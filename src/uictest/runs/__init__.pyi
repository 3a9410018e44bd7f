from .batch import (
    Batch as Batch,
    Keep as Keep,
    all_cases as all_cases,
    batch_of as batch_of,
    run_batch as run_batch,
    with_traces as with_traces,
)
from .observer import Advance as Advance, Observer as Observer, available_processors as available_processors
from .programme import of_programme as of_programme
from .publishing import (
    Published as Published,
    holds_sweep as holds_sweep,
    locked_folder as locked_folder,
    publish_batch as publish_batch,
    publish_run as publish_run,
    result_ids as result_ids,
    run_folder as run_folder,
    why_no_run as why_no_run,
)
from .recorded import (
    CaseOfStop as CaseOfStop,
    RecordedFile as RecordedFile,
    RecordedStops as RecordedStops,
    case_of_stop as case_of_stop,
    each_file as each_file,
    named_map as named_map,
    read_recording as read_recording,
    read_stop as read_stop,
    recorded_batch as recorded_batch,
    require_nothing_stated as require_nothing_stated,
    stops_in_recordings as stops_in_recordings,
    stops_of_series as stops_of_series,
)
from .scenario_files import (
    InvalidInputError as InvalidInputError,
    implausible_trains as implausible_trains,
    is_programme as is_programme,
    is_series as is_series,
    is_sweep as is_sweep,
    load_cases as load_cases,
    load_cases_and_series as load_cases_and_series,
    load_programme as load_programme,
    nothing_selected as nothing_selected,
    only_case as only_case,
    place_of_key as place_of_key,
    programme_files as programme_files,
    read_reference as read_reference,
    reference_of as reference_of,
    scenario_paths as scenario_paths,
    series_files as series_files,
    sweep_files as sweep_files,
)
from .sweep import (
    FinishedSweep as FinishedSweep,
    MaxfailReached as MaxfailReached,
    SweepRequest as SweepRequest,
    ToleranceError as ToleranceError,
    first_pair as first_pair,
    frontier_search as frontier_search,
    measure_names as measure_names,
    run_sweep as run_sweep,
)
from .validation import (
    ValidationRun as ValidationRun,
    load_validations as load_validations,
    publish_validation as publish_validation,
    run_validation as run_validation,
)
