from .identified_air import ModelledPressure as ModelledPressure, identify_air as identify_air
from .identified_case import identified as identified
from .inputs import (
    BenchInput as BenchInput,
    Clock as Clock,
    bench_input as bench_input,
    bypassed_input as bypassed_input,
    clock_of as clock_of,
    joined_inputs as joined_inputs,
    recorded_input as recorded_input,
)
from .recipe import (
    BenchRecipe as BenchRecipe,
    BenchTest as BenchTest,
    load_bench as load_bench,
    recipe_names as recipe_names,
    recipe_path as recipe_path,
    trace_recipe as trace_recipe,
)
from .run import run_bench as run_bench, run_test as run_test
