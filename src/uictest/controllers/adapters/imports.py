"""Modules of the same name beside two Python files: a process holds one of them."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from uictest.controllers.adapters.instance import ControllerError

_FOLDERS: Final[set[Path]] = set()
"""Those of the files that this process has loaded."""


def check_imports(file: Path) -> None:
    """Raise ControllerError where a file would be given the modules of another one's folder for its own."""
    folder = file.parent
    for module in _imported_from(_FOLDERS - {folder}):
        if (folder / module.name).exists() and module.stem != file.stem:
            raise ControllerError(
                f"{file.name} may import {module.name}, and this process has imported the one beside another "
                "controller: leave out --in-process"
            )
    _FOLDERS.add(folder)


def _imported_from(folders: set[Path]) -> Iterator[Path]:
    """Yield the modules and packages that lie in some folders."""
    # Other threads import meanwhile: a copy is made at once, while a walk over the items can be interrupted
    # by the garbage collector. Looking an attribute up would let lazy modules import.
    for name, module in sys.modules.copy().items():
        file = getattr(module, "__dict__", {}).get("__file__")
        if file and "." not in name:
            path = Path(file).parent if Path(file).stem == "__init__" else Path(file)
            if path.parent in folders:
                yield path
