"""The class of a controller in a Python file: looked for in compiled code, which is not run."""

import re
import warnings
from functools import partial
from pathlib import Path
from types import CodeType
from typing import Final

from uictest.plans.scenario.files import Files
from uictest.plans.scenario.parts.external_controller import PythonController
from uictest.plans.scenario.program_files import read_program
from uictest.plans.scenario.yaml import (
    Document,
    Key,
    Map,
    Place,
    display_name,
    dotted,
    entry_at,
    quoted,
    single_error,
    suggestion,
    visible,
)

LARGEST: Final = 128 * 1024
"""Most bytes of a file that is compiled, in some 30 ms; chosen. Others are left to the run."""
_UNSEEN: Final = re.compile(
    rb"\bimport\s*\(?\s*\*|\b(?:global|globals|locals|vars|setattr|exec|eval|modules|__getattr__)\b"
)
"""How a module comes by names that its code does not show."""


def require_class(controller: PythonController, tree: Map, files: Files, key: Key) -> None:
    """Raise ScenarioErrors where the file of a controller is no Python, or cannot have its class.

    Whether a name that is imported or assigned is that of a class shows in a run.
    """
    path, name = Path(controller.python.location), controller.class_name
    content = read_program(files, "python", path).content
    if len(content) > LARGEST:
        return
    code: CodeType | None = files.once(f"code:{path}", partial(_compiled, path, content))
    if code is None or name in code.co_names or _UNSEEN.search(content):
        return
    nested = (each for each in code.co_consts if isinstance(each, CodeType))
    classes = [each.co_name for each in nested if "__qualname__" in each.co_names]
    place = entry_at(tree, ("class",))[0].node.place
    message = visible(f"{path.name} has no class {quoted(name)}")
    raise single_error(place, message, dotted((*key, "class")), visible(suggestion(name, classes)))


def _compiled(path: Path, content: bytes) -> CodeType | None:
    """Return the code of a file; None where it is too deep to tell. Raises ScenarioErrors."""
    try:
        with warnings.catch_warnings(action="ignore"):
            return compile(content, path, "exec", dont_inherit=True)
    except (RecursionError, MemoryError):
        return None
    except (SyntaxError, ValueError) as error:
        text = "" if b"\0" in content else content.decode("utf-8", "replace")
        document = Document(display_name(path), path.parent, text)
        line, column = (max(getattr(error, name, None) or 1, 1) for name in ("lineno", "offset"))
        reason = visible(getattr(error, "msg", str(error)))
        message = f"cannot be imported: {type(error).__name__}: {reason}"
        raise single_error(Place(document, line, column), message) from None
