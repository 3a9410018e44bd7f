from .definition import (
    load_series as load_series,
)
from .model import (
    SeriesFile as SeriesFile,
    Stops as Stops,
    series_schema as series_schema,
)
from .series import (
    PlannedStop as PlannedStop,
    Recorded as Recorded,
    Role as Role,
    Series as Series,
)
from .stop_entry import (
    recorded_by as recorded_by,
    scenario_of as scenario_of,
    values_set_by as values_set_by,
)
