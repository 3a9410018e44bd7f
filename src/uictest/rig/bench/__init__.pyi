from .inputs import (
    BenchInput as BenchInput,
    Clock as Clock,
    bypassed as bypassed,
    joined as joined,
    recorded as recorded,
)
from .loading import (
    BenchTest as BenchTest,
    load_bench as load_bench,
    recipe_names as recipe_names,
    recipe_path as recipe_path,
    run_test as run_test,
    trace_recipe as trace_recipe,
)
from .native import is_compiled as is_compiled
from .run import clock_of as clock_of, run_bench as run_bench
