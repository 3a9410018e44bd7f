from .assignment import FIXED as FIXED, with_value as with_value
from .decimal_quantity import (
    DecimalQuantity as DecimalQuantity,
    DecimalQuantityField as DecimalQuantityField,
    common_unit as common_unit,
    evenly_spaced as evenly_spaced,
    parse_decimal_quantity as parse_decimal_quantity,
    quantity_text as quantity_text,
    rounded_decimal as rounded_decimal,
    rounded_text as rounded_text,
    spaced_by_step as spaced_by_step,
)
from .diagnostics import (
    Diagnostic as Diagnostic,
    ScenarioErrors as ScenarioErrors,
    collecting as collecting,
    diagnose as diagnose,
    in_reading_order as in_reading_order,
    single_error as single_error,
)
from .kinds import (
    BENCH_SCHEMA as BENCH_SCHEMA,
    SCENARIO_SCHEMA as SCENARIO_SCHEMA,
    SERIES_SCHEMA as SERIES_SCHEMA,
    SWEEP_SCHEMA as SWEEP_SCHEMA,
    VALIDATION_SCHEMA as VALIDATION_SCHEMA,
    require_schema as require_schema,
)
from .model import (
    NAME_PATTERN as NAME_PATTERN,
    Inconsistency as Inconsistency,
    Key as Key,
    Model as Model,
    Part as Part,
    PartReference as PartReference,
    Section as Section,
    Source as Source,
    accepted_keys as accepted_keys,
    models_in as models_in,
    quantities_in as quantities_in,
)
from .overrides import (
    Override as Override,
    apply_overrides as apply_overrides,
    parse_overrides as parse_overrides,
    without_axis as without_axis,
)
from .parsing import parse as parse, scalar_value as scalar_value
from .quantities import (
    DEFAULT_SOURCE as DEFAULT_SOURCE,
    SCENARIO_SOURCE as SCENARIO_SOURCE,
    Quantity as Quantity,
    QuantityError as QuantityError,
    parse_quantity as parse_quantity,
)
from .quantity_field import (
    QUANTITY_KEYWORD as QUANTITY_KEYWORD,
    QuantityField as QuantityField,
    default as default,
    of_kind as of_kind,
    written as written,
)
from .reading import (
    LIBRARY as LIBRARY,
    display_name as display_name,
    inherit as inherit,
    is_file as is_file,
    read_document as read_document,
    read_file as read_file,
    read_library as read_library,
    unreadable_error as unreadable_error,
    whole_file as whole_file,
)
from .tree import (
    COMMAND_LINE as COMMAND_LINE,
    Document as Document,
    Entry as Entry,
    Map as Map,
    Node as Node,
    Place as Place,
    Scalar as Scalar,
    Sequence as Sequence,
    as_written as as_written,
    describe as describe,
    entry_at as entry_at,
    nearest as nearest,
    plain as plain,
    quoted as quoted,
    short_example as short_example,
    suggestion as suggestion,
    visible as visible,
)
from .validation import dotted as dotted, validated as validated
