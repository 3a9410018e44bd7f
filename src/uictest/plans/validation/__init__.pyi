from .definition import (
    PlannedComparison as PlannedComparison,
    ValidationFile as ValidationFile,
    ValidationPlan as ValidationPlan,
    load_validation as load_validation,
    plan_of_series as plan_of_series,
)
