"""Any channel of a recording as a page shows it: what it is called, and in which unit."""

from __future__ import annotations

import re
from types import MappingProxyType
from typing import Final

from uictest.core.units import KINDS
from uictest.report.traces.quantities import PLOT_QUANTITIES, WHEELSETS, channel_names

_KEYS: Final = MappingProxyType({name: key for key in PLOT_QUANTITIES for name in channel_names(key)})
"""Channel -> its quantity on every page."""

_WHEELSET: Final = re.compile(rf"(.+)_([{WHEELSETS[0]}-{WHEELSETS[-1]}])")

_BY_SI_UNIT: Final = MappingProxyType(
    {
        kind.canonical: quantity.unit
        for quantity in PLOT_QUANTITIES.values()
        if quantity.scale != 1.0 or quantity.zero != 0.0
        for kind in KINDS.values()
        if quantity.unit in kind.units and kind.canonical != "1"
    }
)
"""SI unit -> the unit that every page shows it in; what a pure number is shown in depends on its channel."""


def shown_unit(channel: str, unit: str) -> str:
    """Return the unit in which a page shows a channel that is recorded in `unit`."""
    if unit == "1" and channel in _KEYS:
        return PLOT_QUANTITIES[_KEYS[channel]].unit
    return _BY_SI_UNIT.get(unit, unit)


def channel_title(channel: str) -> str:
    """Return what a channel is called, e.g. `Tank pressure of wheelset 1`; a name that is no phrase stays."""
    match = _WHEELSET.fullmatch(channel)
    name, wheelset = match.groups() if match else (channel, "")
    if not re.fullmatch(r"[a-z][a-z_]*", name):
        return channel
    title = name.replace("_", " ").capitalize()
    return f"{title} of wheelset {wheelset}" if wheelset else title
