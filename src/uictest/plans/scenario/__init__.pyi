from .case import (
    CAR as CAR,
    LONGEST as LONGEST,
    Case as Case,
    TrainPlace as TrainPlace,
    case_id as case_id,
    chosen_case as chosen_case,
    chosen_train as chosen_train,
    controller_labels as controller_labels,
    sets_controller as sets_controller,
    short_keys as short_keys,
    value_label as value_label,
    with_another_controller as with_another_controller,
    with_wsp_bypassed as with_wsp_bypassed,
)
from .expansion import (
    EXPANSION_KEYS as EXPANSION_KEYS,
    Distribution as Distribution,
    Method as Method,
    Normal as Normal,
    Range as Range,
    Sample as Sample,
    Setting as Setting,
    Variant as Variant,
    Vary as Vary,
    expand as expand,
)
from .feasibility import (
    CarFigures as CarFigures,
    brake_deceleration as brake_deceleration,
    car_figures as car_figures,
    plausible_spans as plausible_spans,
)
from .json_schema import (
    PART_MODELS as PART_MODELS,
    json_schema as json_schema,
    part_schema as part_schema,
    schema_of as schema_of,
)
from .loading import (
    LoadedCase as LoadedCase,
    load as load,
    load_controller as load_controller,
    load_file as load_file,
    load_part as load_part,
    load_part_file as load_part_file,
    load_with_trees as load_with_trees,
)
from .model import SURVEY as SURVEY, Drag as Drag, Rig as Rig, Scenario as Scenario, check_id as check_id
from .overrides import (
    CONDITION as CONDITION,
    FIXED as FIXED,
    Override as Override,
    apply_overrides as apply_overrides,
    changed_alone as changed_alone,
    parse_overrides as parse_overrides,
    sets_friction as sets_friction,
    with_value as with_value,
    without_axis as without_axis,
)
from .parts.applicability import (
    Applicability as Applicability,
    Nominal as Nominal,
    TestConditions as TestConditions,
    UnmetCondition as UnmetCondition,
    applies_to as applies_to,
    corrections as corrections,
    observed_quantities as observed_quantities,
    test_conditions_of as test_conditions_of,
    unmet_conditions as unmet_conditions,
)
from .parts.brake import (
    EMERGENCY as EMERGENCY,
    Brake as Brake,
    DynamicBrake as DynamicBrake,
    Pad as Pad,
    PadLaw as PadLaw,
    TrackBrake as TrackBrake,
)
from .parts.compensation import (
    COMPENSATION_SETTINGS as COMPENSATION_SETTINGS,
    FIT_HINT as FIT_HINT,
    RIG_SOURCE as RIG_SOURCE,
    Compensation as Compensation,
    CylinderDynamics as CylinderDynamics,
    FourPhaseHysteresis as FourPhaseHysteresis,
    ModuleAir as ModuleAir,
    misfit as misfit,
    misfits as misfits,
    rig_as_built as rig_as_built,
    rig_differences as rig_differences,
    with_listed_rig as with_listed_rig,
)
from .parts.controller import ExternalController as ExternalController
from .parts.criteria import (
    Criteria as Criteria,
    Criterion as Criterion,
    criteria_of_the_same_name as criteria_of_the_same_name,
)
from .parts.equipment import (
    BrakeSystem as BrakeSystem,
    Caliper as Caliper,
    Disc as Disc,
    DiscRing as DiscRing,
    Sensors as Sensors,
)
from .parts.fault import Fault as Fault
from .parts.measures import supposed_definition as supposed_definition
from .parts.named_file import (
    LARGEST_SEED as LARGEST_SEED,
    PASS as PASS,
    Expect as Expect,
    Expectation as Expectation,
    NamedFile as NamedFile,
    ShareOfStops as ShareOfStops,
    TestFile as TestFile,
    WrittenExpectation as WrittenExpectation,
    expectation_of as expectation_of,
    in_order_of_ids as in_order_of_ids,
    named_requirements as named_requirements,
    read_requirement_list as read_requirement_list,
)
from .parts.rail import (
    FrictionOverSpeed as FrictionOverSpeed,
    FrictionProfile as FrictionProfile,
    Rail as Rail,
    RailCondition as RailCondition,
    Sander as Sander,
)
from .parts.rail_cleaning import CreepCurve as CreepCurve
from .parts.search import (
    FailsIn as FailsIn,
    Search as Search,
    fault_name as fault_name,
    kinds_named as kinds_named,
)
from .parts.vehicle import (
    WHEELSET_NUMBERS as WHEELSET_NUMBERS,
    Coupler as Coupler,
    Vehicle as Vehicle,
    load_share as load_share,
    wheelset_value as wheelset_value,
)
from .programs import with_parameters as with_parameters
from .resolution import (
    PART_KEYS as PART_KEYS,
    PART_KINDS as PART_KINDS,
    Parts as Parts,
    SourcedNumber as SourcedNumber,
    is_path as is_path,
    numbers as numbers,
    resolve as resolve,
    with_default_parts as with_default_parts,
)
from .train import (
    coupling_problem as coupling_problem,
    own_keys as own_keys,
    program_problems as program_problems,
    resolved_cars as resolved_cars,
)
from .yaml.diagnostics import Diagnostic as Diagnostic, ScenarioErrors as ScenarioErrors
from .yaml.files import (
    PROGRAMME_SUFFIXES as PROGRAMME_SUFFIXES,
    SERIES_SUFFIXES as SERIES_SUFFIXES,
    SWEEP_SUFFIXES as SWEEP_SUFFIXES,
    Files as Files,
    Roots as Roots,
    link_outside as link_outside,
)
from .yaml.model import (
    DESCRIPTIVE as DESCRIPTIVE,
    DescribedValue as DescribedValue,
    described_values as described_values,
    is_changed as is_changed,
    mark_of as mark_of,
    values_in as values_in,
)
from .yaml.quantities import Quantity as Quantity
