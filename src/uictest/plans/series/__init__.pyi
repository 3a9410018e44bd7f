from .definition import (
    load_series as load_series,
)
from .model import (
    PlannedStop as PlannedStop,
    Recorded as Recorded,
    Role as Role,
    Series as Series,
    SeriesFile as SeriesFile,
    Stops as Stops,
    series_schema as series_schema,
)
from .validation import (
    PlannedComparison as PlannedComparison,
    ValidationFile as ValidationFile,
    ValidationPlan as ValidationPlan,
    load_validation as load_validation,
    plan_of_series as plan_of_series,
)
