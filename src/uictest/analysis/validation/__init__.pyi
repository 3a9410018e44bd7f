from .document import (
    RESULT as RESULT,
    Agreement as Agreement,
    ComparedStop as ComparedStop,
    StopUnderConditions as StopUnderConditions,
    Validation as Validation,
    ValidationReference as ValidationReference,
    agreement_of as agreement_of,
    as_recorded as as_recorded,
    figures_of as figures_of,
    read_validation as read_validation,
    relative_difference as relative_difference,
    seed_of as seed_of,
    validation_json as validation_json,
    validation_of as validation_of,
)
from .domain import (
    Columns as Columns,
    Conditions as Conditions,
    Domain as Domain,
    conditions_of as conditions_of,
    deviations as deviations,
    deviations_of_stops as deviations_of_stops,
    domains_of as domains_of,
    is_condition as is_condition,
)
from .report import (
    figures_table as figures_table,
    stops_table as stops_table,
    tally as tally,
    validation_document as validation_document,
    validation_html as validation_html,
)
