from .plan.controllers import programs_of as programs_of
from .plan.decimal_quantity import parse_decimal_quantity as parse_decimal_quantity
from .plan.definition import load_sweep as load_sweep
from .plan.nominal import drawn_ranges as drawn_ranges, nominal_plan as nominal_plan
from .plan.plan import Plan as Plan
from .plan.schema import sweep_schema as sweep_schema
from .running.case_selection import CaseSelection as CaseSelection, select_cases as select_cases
from .running.chunk import (
    ChunkRunner as ChunkRunner,
    RunBlock as RunBlock,
    WriteChunk as WriteChunk,
    chunk_runner as chunk_runner,
    run_on_threads as run_on_threads,
)
from .running.cluster import (
    ClusterError as ClusterError,
    check_address as check_address,
    run_on_cluster as run_on_cluster,
)
from .running.manifest import SCHEMA as SCHEMA, sweep_manifest as sweep_manifest
from .running.shard import Shard as Shard, parse_shard as parse_shard
from .running.store import (
    ChangedInputsError as ChangedInputsError,
    ChunkStore as ChunkStore,
    MissingChunksError as MissingChunksError,
)
from .running.survey import SURVEY_TABLE as SURVEY_TABLE
from .running.table import measure_columns as measure_columns
from .summaries.frontier import (
    FrontierError as FrontierError,
    FrontierSearch as FrontierSearch,
    verdicts_of as verdicts_of,
)
from .summaries.summary import SweepSummary as SweepSummary, summarize as summarize
from .summaries.worst import full_cases as full_cases
