"""Controllers that installed packages have registered: entry points of the group ``uictest.controllers``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from uictest.controllers.declared import shown_version

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP: Final = "uictest.controllers"


def installed_names() -> tuple[str, ...]:
    """Return the names of all registered controllers, sorted; no package is imported."""
    from importlib.metadata import entry_points  # only unknown names need it

    return tuple(sorted(entry_points(group=GROUP).names))


def installed(name: str) -> tuple[EntryPoint, ...]:
    """Return what packages have registered under a name: nothing, one entry, or several that collide."""
    from importlib.metadata import entry_points

    return tuple(entry_points(group=GROUP, name=name))


def package_of(entry: EntryPoint) -> str:
    """Return name and version of the package that has registered a controller."""
    return "" if entry.dist is None else f"{entry.dist.name} {entry.dist.version}"


def installed_version(name: str) -> str:
    """Return name and version of the package that has registered a controller, empty if none or several have.

    Only the metadata of the package are read; it is not imported.
    """
    entries = installed(name)
    return shown_version(package_of(entries[0])) if len(entries) == 1 else ""


def installed_module(name: str) -> str:
    """Return the module that holds what is registered under a name, empty if no or several packages have it.

    Only the metadata of the package are read; it is not imported.
    """
    entries = installed(name)
    return entries[0].module if len(entries) == 1 else ""
