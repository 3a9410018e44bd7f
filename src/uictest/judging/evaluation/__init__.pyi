from .case import (
    asks_for_rail as asks_for_rail,
    error_result as error_result,
    evaluate as evaluate,
    evaluate_simulated as evaluate_simulated,
    may_be_biased as may_be_biased,
    with_rail as with_rail,
)
from .decision import (
    Bounds as Bounds,
    Coverage as Coverage,
    Decision as Decision,
    MissingData as MissingData,
    bounds_of as bounds_of,
)
from .effective_parts import (
    EffectivePart as EffectivePart,
    Parameter as Parameter,
    Program as Program,
    effective_parts as effective_parts,
    parts_document as parts_document,
    parts_of as parts_of,
    parts_table as parts_table,
    program_in as program_in,
    program_of as program_of,
    recorded_parts as recorded_parts,
)
from .firmness import (
    CalibratedDraws as CalibratedDraws,
    Firmness as Firmness,
    FirmnessStatus as FirmnessStatus,
    NumberEffect as NumberEffect,
    Turn as Turn,
    VerdictFirmness as VerdictFirmness,
    WrittenFirmness as WrittenFirmness,
)
from .json_values import (
    Number as Number,
    Outcome as Outcome,
    absent_if_empty as absent_if_empty,
    from_json_form as from_json_form,
    json_form as json_form,
    required as required,
    to_json_form as to_json_form,
)
from .judgement import (
    Detail as Detail,
    by_reading as by_reading,
    definition_texts as definition_texts,
    judge as judge,
    verdict_of as verdict_of,
)
from .margins import guiding_margin as guiding_margin
from .outcome import (
    RailValidity as RailValidity,
    RequirementStatus as RequirementStatus,
    TestValidity as TestValidity,
    deciding_verdicts as deciding_verdicts,
    failed_checks as failed_checks,
    is_expected as is_expected,
    missed_requirements as missed_requirements,
    outcome_of as outcome_of,
    reasons_of as reasons_of,
    requirements_of as requirements_of,
    validity_of as validity_of,
    why_no_test as why_no_test,
)
from .repeated_case import (
    OutcomeRule as OutcomeRule,
    SimulatedRepeat as SimulatedRepeat,
    evaluate_repeats as evaluate_repeats,
)
from .repeats import (
    RepeatedStop as RepeatedStop,
    Repeats as Repeats,
    Spread as Spread,
    column_medians as column_medians,
    seeds_text as seeds_text,
    spread_of as spread_of,
)
from .result import (
    CarInTrain as CarInTrain,
    CaseResult as CaseResult,
    CouplerForces as CouplerForces,
    Deviation as Deviation,
    DomainOfValidity as DomainOfValidity,
    NamedParts as NamedParts,
    WrittenCaseResult as WrittenCaseResult,
    cases_document as cases_document,
    cases_of as cases_of,
    narrowest_margin as narrowest_margin,
    result_document as result_document,
    results_of as results_of,
    to_json as to_json,
)
from .verdict import (
    AppliedDefinition as AppliedDefinition,
    Layer as Layer,
    OverStops as OverStops,
    ReadVerdict as ReadVerdict,
    Sensitivity as Sensitivity,
    Status as Status,
    Verdict as Verdict,
    VerdictInterval as VerdictInterval,
    WrittenVerdict as WrittenVerdict,
    relative_margin as relative_margin,
)
