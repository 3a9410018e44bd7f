from .catalogue.reference import NO_REFERENCE as NO_REFERENCE
from .catalogue.sliding import SLIDE_CLASS as SLIDE_CLASS, SLOW_SHARE_CLASS as SLOW_SHARE_CLASS
from .contact import (
    begin_contact as begin_contact,
    begin_utilisation as begin_utilisation,
    close_contacts as close_contacts,
    observe_contact as observe_contact,
)
from .layouts import STOP_MEASURES as STOP_MEASURES, WHEELSET_MEASURES as WHEELSET_MEASURES
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
from .monitoring import observe_monitoring as observe_monitoring, reports_wheelset as reports_wheelset
from .noted_samples import note_samples as note_samples
from .records import (
    END_SPEEDS as END_SPEEDS,
    SLOW_TIMES as SLOW_TIMES,
    SPEED_CLASSES as SPEED_CLASSES,
    WINDOW_SECONDS as WINDOW_SECONDS,
    MeasureDefinition as MeasureDefinition,
    StopMeasures as StopMeasures,
    WheelsetMeasures as WheelsetMeasures,
)
from .registry import (
    MEASURES as MEASURES,
    STOP_COLUMNS as STOP_COLUMNS,
    WHEELSET_COLUMNS as WHEELSET_COLUMNS,
    column_unit as column_unit,
    stop_column_values as stop_column_values,
    wheelset_column_values as wheelset_column_values,
    without_wheelset as without_wheelset,
)
from .replay import (
    FAULT_COLUMNS as FAULT_COLUMNS,
    Cell as Cell,
    Faults as Faults,
    Replay as Replay,
    place_of as place_of,
    samples_of as samples_of,
)
from .samples import (
    TrainState as TrainState,
    WheelsetState as WheelsetState,
    keep_tables as keep_tables,
    observe_sample as observe_sample,
)
from .train import (
    begin_build_up as begin_build_up,
    begin_train as begin_train,
    begin_window as begin_window,
    keep_window as keep_window,
    note_standstill as note_standstill,
    observe_build_up as observe_build_up,
    observe_reservoir_margin as observe_reservoir_margin,
    observe_train as observe_train,
)
from .wheelset import (
    begin_slides as begin_slides,
    begin_slow_times as begin_slow_times,
    begin_wheelset as begin_wheelset,
    keep_slide as keep_slide,
    keep_slow_times as keep_slow_times,
    observe_reaction as observe_reaction,
    observe_reference as observe_reference,
    observe_wheelset as observe_wheelset,
)
