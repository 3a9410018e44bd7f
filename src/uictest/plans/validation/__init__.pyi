from .definition import (
    VALIDATION_SCHEMA as VALIDATION_SCHEMA,
    PlannedComparison as PlannedComparison,
    ValidationFile as ValidationFile,
    ValidationPlan as ValidationPlan,
    load_validation as load_validation,
    plan_of_series as plan_of_series,
)
