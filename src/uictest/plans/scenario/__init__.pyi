from .applicability import (
    TestConditions as TestConditions,
    UnmetCondition as UnmetCondition,
    applies_to as applies_to,
    corrections as corrections,
    observed_quantities as observed_quantities,
    test_conditions_of as test_conditions_of,
    unmet_conditions as unmet_conditions,
)
from .brake_force import brake_deceleration as brake_deceleration
from .case import (
    Case as Case,
    TrainPlace as TrainPlace,
    chosen_case as chosen_case,
    chosen_train as chosen_train,
    with_another_controller as with_another_controller,
    with_wsp_bypassed as with_wsp_bypassed,
)
from .compensation_fit import (
    FIT_HINT as FIT_HINT,
    FIT_KEYS as FIT_KEYS,
    RIG_SOURCE as RIG_SOURCE,
    misfit as misfit,
    misfits as misfits,
    rig_as_built as rig_as_built,
    rig_differences as rig_differences,
    with_listed_rig as with_listed_rig,
)
from .coupling import coupling_problem as coupling_problem, program_problems as program_problems
from .declared_parameters import with_parameters as with_parameters
from .expansion import (
    EXPANSION_KEYS as EXPANSION_KEYS,
    Setting as Setting,
    Variant as Variant,
    expand as expand,
)
from .expectation import (
    PASS as PASS,
    Expect as Expect,
    Expectation as Expectation,
    WrittenExpectation as WrittenExpectation,
    expectation_of as expectation_of,
)
from .files import (
    SERIES_SUFFIXES as SERIES_SUFFIXES,
    SWEEP_SUFFIXES as SWEEP_SUFFIXES,
    Files as Files,
    Roots as Roots,
    link_outside as link_outside,
)
from .identifiers import (
    CAR as CAR,
    LONGEST as LONGEST,
    case_id as case_id,
    controller_labels as controller_labels,
    sets_controller as sets_controller,
    short_keys as short_keys,
    value_label as value_label,
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
    load_file as load_file,
    load_with_trees as load_with_trees,
)
from .model import Scenario as Scenario
from .overrides import (
    FIXED as FIXED,
    Override as Override,
    apply_overrides as apply_overrides,
    parse_overrides as parse_overrides,
    with_value as with_value,
    without_axis as without_axis,
)
from .part_loading import (
    load_controller as load_controller,
    load_part as load_part,
    load_part_file as load_part_file,
)
from .parts.brake import BrakeSystem as BrakeSystem, DiscRing as DiscRing
from .parts.compensation import (
    COMPENSATION_SETTINGS as COMPENSATION_SETTINGS,
    Compensation as Compensation,
    ModuleAir as ModuleAir,
)
from .parts.coupler import Coupler as Coupler
from .parts.criteria import Criteria as Criteria, Criterion as Criterion
from .parts.dynamic_brake import DynamicBrake as DynamicBrake
from .parts.external_controller import ExternalController as ExternalController
from .parts.fault import Fault as Fault
from .parts.measures import MeasureDefinitions as MeasureDefinitions
from .parts.named_file import (
    LARGEST_SEED as LARGEST_SEED,
    NamedFile as NamedFile,
    ShareOfStops as ShareOfStops,
    TestFile as TestFile,
)
from .parts.pad import PadLaw as PadLaw
from .parts.rail import (
    CreepCurve as CreepCurve,
    FrictionProfile as FrictionProfile,
    RailCondition as RailCondition,
)
from .parts.reading import (
    Applicability as Applicability,
    Nominal as Nominal,
    RangedDefinition as RangedDefinition,
    supposed_definition as supposed_definition,
)
from .parts.record import check_id as check_id
from .parts.sand import Sand as Sand, Sander as Sander
from .parts.track_brake import EMERGENCY as EMERGENCY, TrackBrake as TrackBrake
from .parts.vary import (
    Distribution as Distribution,
    Method as Method,
    Normal as Normal,
    Range as Range,
    Sample as Sample,
    Vary as Vary,
)
from .parts.vehicle import Vehicle as Vehicle
from .parts.wheelsets import (
    DESCRIPTIVE as DESCRIPTIVE,
    WHEELSET_NUMBERS as WHEELSET_NUMBERS,
    Value as Value,
    is_changed as is_changed,
    mark_of as mark_of,
    values_in as values_in,
    wheelset_keys as wheelset_keys,
    wheelset_value as wheelset_value,
)
from .plausibility import (
    CarFigures as CarFigures,
    Implausible as Implausible,
    car_figures as car_figures,
    plausible_spans as plausible_spans,
)
from .rail_friction import (
    CONDITION as CONDITION,
    changed_alone as changed_alone,
    sets_friction as sets_friction,
)
from .references import Parts as Parts, is_path as is_path
from .requirement_list import (
    in_order_of_ids as in_order_of_ids,
    named_requirements as named_requirements,
    read_requirement_list as read_requirement_list,
)
from .resolution import (
    PART_KEYS as PART_KEYS,
    PART_KINDS as PART_KINDS,
    SourcedNumber as SourcedNumber,
    numbers as numbers,
    resolve as resolve,
    with_default_parts as with_default_parts,
)
from .resolved_cars import own_keys as own_keys, resolved_cars as resolved_cars
from .sections import SURVEY as SURVEY, load_share as load_share
from .train import is_train as is_train
from .yaml.diagnostics import Diagnostic as Diagnostic, ScenarioErrors as ScenarioErrors
from .yaml.quantities import Quantity as Quantity
