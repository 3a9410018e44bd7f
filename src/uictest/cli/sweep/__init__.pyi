from .arguments import (
    cluster_address as cluster_address,
    frontier_search as frontier_search,
    map_pair as map_pair,
    measure_names as measure_names,
    selected_cases as selected_cases,
    shard_of as shard_of,
)
from .display import show_ids as show_ids
from .execution import execute_sweep as execute_sweep
