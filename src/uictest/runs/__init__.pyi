from .batch import (
    Batch as Batch,
    BatchRun as BatchRun,
    Keep as Keep,
    batch_of as batch_of,
    run_batch as run_batch,
    with_domains as with_domains,
)
from .drawing import with_traces as with_traces
from .observer import Observer as Observer, available_processors as available_processors
from .publishing import Published as Published, publish_batch as publish_batch, publish_run as publish_run
from .recorded.batch import (
    JudgedRecordings as JudgedRecordings,
    RecordedBatch as RecordedBatch,
    judge_recordings as judge_recordings,
)
from .recorded.conditions import (
    CaseOfStop as CaseOfStop,
    MissingStatementsError as MissingStatementsError,
    case_of_stop as case_of_stop,
    statements_of as statements_of,
)
from .recorded.files import (
    PreparationError as PreparationError,
    RecordedFile as RecordedFile,
    each_file as each_file,
    named_map as named_map,
    prepared_map as prepared_map,
    read_files as read_files,
    stop_names as stop_names,
)
from .recorded.series import read_recorded_series as read_recorded_series
from .run_folders import holds_sweep as holds_sweep, run_folder as run_folder, why_no_run as why_no_run
from .scenario_files import (
    DEFAULT_FOLDER as DEFAULT_FOLDER,
    InvalidInputError as InvalidInputError,
    is_series as is_series,
    load_cases as load_cases,
    load_cases_and_series as load_cases_and_series,
    load_series as load_series,
    scenario_paths as scenario_paths,
    series_files as series_files,
)
from .selection import (
    nothing_selected as nothing_selected,
    only_case as only_case,
    result_ids as result_ids,
    select_cases as select_cases,
    select_series as select_series,
)
from .series_runs import cases_of as cases_of
from .sweep.publishing import FinishedSweep as FinishedSweep
from .sweep.run import (
    MaxfailReached as MaxfailReached,
    SweepObserver as SweepObserver,
    SweepRun as SweepRun,
    reason_missed as reason_missed,
)
from .sweep.whole import (
    ToleranceError as ToleranceError,
    first_pair as first_pair,
    frontier_search as frontier_search,
    measure_names as measure_names,
    run_sweep as run_sweep,
)
from .validation.run import (
    ValidationRun as ValidationRun,
    load_validations as load_validations,
    publish_validation as publish_validation,
    read_reference as read_reference,
    reference_of as reference_of,
    run_validation as run_validation,
)
