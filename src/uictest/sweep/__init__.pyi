from .junit import junit_xml as junit_xml
from .map_text import map_lines as map_lines
from .plan.amount import parse_amount as parse_amount
from .plan.definition import load_sweep as load_sweep
from .plan.nominal import drawn_ranges as drawn_ranges
from .plan.plan import Plan as Plan
from .plan.schema import sweep_schema as sweep_schema
from .running.chunk import ChunkRunner as ChunkRunner, chunk_runner as chunk_runner
from .running.cluster import (
    ClusterError as ClusterError,
    check_address as check_address,
    run_on_cluster as run_on_cluster,
)
from .running.execution import run_parts as run_parts
from .running.manifest import SCHEMA as SCHEMA, sweep_manifest as sweep_manifest
from .running.selection import Selection as Selection, select as select
from .running.shard import Shard as Shard, parse_shard as parse_shard
from .running.simulating import NoDeviceError as NoDeviceError, is_warm as is_warm
from .running.store import (
    ChangedInputsError as ChangedInputsError,
    MissingChunksError as MissingChunksError,
    Store as Store,
)
from .running.table import figure_names as figure_names
from .summaries.findings import (
    SweepFindings as SweepFindings,
    gather as gather,
    write_findings as write_findings,
)
from .summaries.frontier import (
    FrontierError as FrontierError,
    FrontierScan as FrontierScan,
    FrontierSearch as FrontierSearch,
)
from .summaries.sensitivity import Sensitivity as Sensitivity
from .summaries.tally import Count as Count, Tally as Tally
from .summaries.verdicts import verdicts_of as verdicts_of
from .summaries.worst import cases_of as cases_of
