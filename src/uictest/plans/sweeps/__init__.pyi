from .base_case import (
    REGULAR_STEP as REGULAR_STEP,
    SURVEY_STEP as SURVEY_STEP,
    inconsistencies as inconsistencies,
    is_free as is_free,
    train_problem as train_problem,
    value_at as value_at,
    with_values as with_values,
)
from .column import (
    Column as Column,
    ParameterValue as ParameterValue,
    RangedNumber as RangedNumber,
    content_of as content_of,
    kind_of as kind_of,
    listed_column as listed_column,
    numbers_without_range as numbers_without_range,
    ranged_numbers as ranged_numbers,
)
from .definition import load_sweep as load_sweep
from .plan import (
    Group as Group,
    ListedGroup as ListedGroup,
    ParameterDraw as ParameterDraw,
    Plan as Plan,
    controllers_of as controllers_of,
    drawn_ranges as drawn_ranges,
    each_controller as each_controller,
    in_survey_step as in_survey_step,
    programs_of as programs_of,
    saltelli_sample as saltelli_sample,
    scenarios_with_each as scenarios_with_each,
)
from .sampling import sobol_blocks as sobol_blocks
