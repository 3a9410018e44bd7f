from .columns import (
    Columns as Columns,
    deviations_of_stops as deviations_of_stops,
)
from .document import (
    RESULT as RESULT,
    StopUnderConditions as StopUnderConditions,
    Validation as Validation,
    ValidationReference as ValidationReference,
    read_validation as read_validation,
    validation_json as validation_json,
    validation_of as validation_of,
)
from .domain import (
    Conditions as Conditions,
    Domain as Domain,
    conditions_of as conditions_of,
    deviations as deviations,
    domains_of as domains_of,
    is_condition as is_condition,
)
from .page import validation_html as validation_html
from .report import (
    figures_table as figures_table,
    stops_table as stops_table,
    tally as tally,
    validation_document as validation_document,
)
from .stops import (
    Agreement as Agreement,
    ComparedStop as ComparedStop,
    agreement_of as agreement_of,
    as_recorded as as_recorded,
    figures_of as figures_of,
    seed_of as seed_of,
)
