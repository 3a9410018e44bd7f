from .case import (
    JUDGED_KEYS as JUDGED_KEYS,
    error_result as error_result,
    evaluate as evaluate,
    evaluate_simulated as evaluate_simulated,
)
from .coverage import Coverage as Coverage, MissingData as MissingData
from .document import (
    cases_document as cases_document,
    cases_of as cases_of,
    result_document as result_document,
    results_of as results_of,
    to_json as to_json,
)
from .effective_parts import EffectiveParts as EffectiveParts
from .json_form import (
    Number as Number,
    from_json_form as from_json_form,
    json_form as json_form,
    required as required,
    to_json_form as to_json_form,
)
from .judgement import judge as judge
from .parameters import (
    EffectivePart as EffectivePart,
    Parameter as Parameter,
    parts_document as parts_document,
    parts_of as parts_of,
    parts_table as parts_table,
)
from .program import Program as Program, program_in as program_in, program_of as program_of
from .result import (
    CaseResult as CaseResult,
    NamedParts as NamedParts,
    narrowest_margin as narrowest_margin,
)
from .verdict import (
    AppliedDefinition as AppliedDefinition,
    Sensitivity as Sensitivity,
    Status as Status,
    Verdict as Verdict,
    VerdictInterval as VerdictInterval,
)
