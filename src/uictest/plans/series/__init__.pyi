from .loading import (
    PlannedComparison as PlannedComparison,
    ValidationFile as ValidationFile,
    ValidationPlan as ValidationPlan,
    load_series as load_series,
    load_validation as load_validation,
    plan_of_series as plan_of_series,
)
from .model import (
    PlannedStop as PlannedStop,
    Role as Role,
    Series as Series,
    cases_run_together as cases_run_together,
    series_of as series_of,
    series_schema as series_schema,
)
from .programme import (
    FRICTION as FRICTION,
    PlannedTest as PlannedTest,
    Programme as Programme,
    ProgrammeFile as ProgrammeFile,
    RailStops as RailStops,
    load_programme as load_programme,
)
