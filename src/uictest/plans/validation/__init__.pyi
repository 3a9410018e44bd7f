from .definition import (
    load_validation as load_validation,
    plan_of_series as plan_of_series,
)
from .model import (
    VALIDATION_SCHEMA as VALIDATION_SCHEMA,
    ValidationFile as ValidationFile,
)
from .plan import (
    PlannedComparison as PlannedComparison,
    ValidationPlan as ValidationPlan,
)
