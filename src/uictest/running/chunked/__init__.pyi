from .chunk import (
    CaseSelection as CaseSelection,
    ChunkRunner as ChunkRunner,
    Shard as Shard,
    WriteChunk as WriteChunk,
    chunk_runner as chunk_runner,
    parse_shard as parse_shard,
    run_on_threads as run_on_threads,
    select_cases as select_cases,
)
from .cluster import (
    ClusterError as ClusterError,
    check_address as check_address,
    run_on_cluster as run_on_cluster,
)
from .many_stops import (
    ManyStops as ManyStops,
    PlannedCase as PlannedCase,
    RunBlock as RunBlock,
    VariedCase as VariedCase,
    VariedTrain as VariedTrain,
)
from .store import (
    ChangedInputsError as ChangedInputsError,
    ChunkStore as ChunkStore,
    MissingChunksError as MissingChunksError,
    sweep_manifest as sweep_manifest,
)
from .table import (
    SURVEY_TABLE as SURVEY_TABLE,
    measure_columns as measure_columns,
    named_controller as named_controller,
    number_column as number_column,
    repeated_cases as repeated_cases,
    survey_step as survey_step,
    surveyed_cases as surveyed_cases,
    text_column as text_column,
    wheelset_columns as wheelset_columns,
)
