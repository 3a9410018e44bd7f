from .agreement import (
    Agreement as Agreement,
    Differences as Differences,
    agreement_of as agreement_of,
)
from .columns import (
    Columns as Columns,
    DeviationOfStops as DeviationOfStops,
    deviations_of_stops as deviations_of_stops,
)
from .conditions import (
    Conditions as Conditions,
    conditions_of as conditions_of,
    is_condition as is_condition,
)
from .document import (
    RESULT as RESULT,
    Validation as Validation,
    ValidationReference as ValidationReference,
    read_validation as read_validation,
    validation_json as validation_json,
)
from .domain import (
    Domain as Domain,
    deviations as deviations,
    domains_of as domains_of,
)
from .report import (
    figures_csv as figures_csv,
    figures_table as figures_table,
    markdown as markdown,
    stops_csv as stops_csv,
    stops_table as stops_table,
    tally as tally,
    validation_lines as validation_lines,
)
from .stops import (
    ComparedStop as ComparedStop,
    as_recorded as as_recorded,
    figures_of as figures_of,
    seed_of as seed_of,
)
from .summary import (
    StopUnderConditions as StopUnderConditions,
    validation_of as validation_of,
)
