"""A recording as a data frame."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd


def frame_of(
    channels: Mapping[str, NDArray[Any]], units: Mapping[str, str], metadata: Mapping[str, str]
) -> pd.DataFrame:
    """Return one column per channel over the first, which is the time; units and facts in `attrs`."""
    import pandas as pd

    time, *others = channels
    index = pd.Index(channels[time], name=time)
    frame = pd.DataFrame({name: channels[name] for name in others}, index=index)
    frame.attrs = {"units": dict(units), "metadata": dict(metadata)}
    return frame
