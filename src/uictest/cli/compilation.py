"""A word before the wait: the rig is compiled at its first use after an installation or a change."""

from __future__ import annotations

from uictest.cli.streams import message


def announce_compilation(*, warm: bool, quiet: bool = False) -> None:
    """Say that the rig is compiled first, unless it lies compiled in the cache (`warm`) or all is `quiet`."""
    if not (warm or quiet):
        message("uictest: compiling the rig (once per installation, ten to forty seconds)...")
