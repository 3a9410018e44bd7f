from .catalogue import (
    MEASURES as MEASURES,
    STOP_COLUMNS as STOP_COLUMNS,
    WHEELSET_COLUMNS as WHEELSET_COLUMNS,
    column_unit as column_unit,
    measure_of_column as measure_of_column,
    stop_column_values as stop_column_values,
    wheelset_column_values as wheelset_column_values,
    without_wheelset as without_wheelset,
)
from .catalogue.sliding import SLIDE_CLASS as SLIDE_CLASS, SLOW_SHARE_CLASS as SLOW_SHARE_CLASS
from .catalogue.stopping import NO_REFERENCE as NO_REFERENCE
from .measure import (
    Column as Column,
    Course as Course,
    Measure as Measure,
    MeasureValue as MeasureValue,
    RecordedData as RecordedData,
    ShownWhen as ShownWhen,
    StopColumn as StopColumn,
    WheelsetColumn as WheelsetColumn,
    Wheelsets as Wheelsets,
)
from .records import (
    MeasureDefinition as MeasureDefinition,
    StopMeasures as StopMeasures,
    WheelsetMeasures as WheelsetMeasures,
)
from .replay import (
    FAULT_COLUMNS as FAULT_COLUMNS,
    Cell as Cell,
    Faults as Faults,
    Replay as Replay,
    index_of as index_of,
    samples_of as samples_of,
)
from .samples import (
    STOP_MEASURES as STOP_MEASURES,
    WHEELSET_MEASURES as WHEELSET_MEASURES,
    TrainState as TrainState,
    WheelsetState as WheelsetState,
    keep_tables as keep_tables,
    note_samples as note_samples,
    observe_sample as observe_sample,
)
from .train import (
    begin_train as begin_train,
    begin_window as begin_window,
    close_contacts as close_contacts,
    note_standstill as note_standstill,
)
from .wheelset import (
    begin_slides as begin_slides,
    begin_slow_times as begin_slow_times,
    begin_wheelset as begin_wheelset,
    observe_monitoring as observe_monitoring,
    observe_reaction as observe_reaction,
    observe_reference as observe_reference,
    reports_wheelset as reports_wheelset,
)
