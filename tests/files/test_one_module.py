"""Nothing but `uictest.core.files` writes, renames or removes."""

import ast
from functools import cache
from pathlib import Path

import uictest

PACKAGE = Path(uictest.__file__).parent

CHANGING = {
    *("write_text", "write_bytes", "mkdir", "makedirs", "rmdir", "removedirs", "unlink", "rmtree", "move"),
    *("rename", "renames", "symlink", "symlink_to", "hardlink_to", "touch", "truncate", "mkfifo", "chmod"),
    *("copy2", "copyfile", "copytree", "mkdtemp", "mkstemp", "TemporaryDirectory", "TemporaryFile"),
    *("NamedTemporaryFile", "SpooledTemporaryFile", "savez", "tofile"),
}
"""Functions and methods that change what is on the disk."""

CHILD = "the temporary folder of a child process, which ends by a signal: whoever ends last removes it"
SHARED = "a file without a name: the memory that a child shares"
READER = "a reading process writes into the temporary folder that its parent made for it, and ends"
BUFFER = "a buffer in memory"
EXCEPTIONS = {
    "report/formats/csv.py": {"truncate": BUFFER},
    "rig/external/worker.py": {"TemporaryDirectory": CHILD, "TemporaryFile": SHARED, "truncate": SHARED},
    "rig/external/child.py": {"fdopen": "a pipe"},
    "core/guarded_process.py": {"rmtree": CHILD},
    "core/recording/formats/isolation.py": {"write_text": READER, "write_bytes": READER},
    "core/recording/formats/tdms.py": {"open": READER, "tofile": READER},
    "cli/__init__.py": {"open": "the null device in the place of a closed stream"},
    "cli/output.py": {"open": "the null device in the place of a closed stream"},
}
"""Module -> what it may call, and why."""


def changing_calls(tree):
    """Yield line and name of each call that changes, or may change, what is on the disk."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        of_os = isinstance(node.func, ast.Attribute) and _is_os(node.func.value)
        name = getattr(node.func, "attr", getattr(node.func, "id", ""))
        if (
            name in CHANGING
            or (of_os and name in ("open", "remove", "replace", "link", "fdopen") and not _reads(node))
            # The method of a path takes one argument, that of a text two, that of dataclasses keywords.
            or (name == "replace" and len(node.args) == 1 and not node.keywords)
            or (name == "open" and not of_os and not _reads(node))
        ):
            yield node.lineno, name


def _is_os(value):
    return isinstance(value, ast.Name) and value.id == "os"


def _reads(call):
    """Return whether `open` states a mode, or none, that only reads."""
    if ast.unparse(call.func) == "os.open":
        return ast.unparse(call.args[1]) == "os.O_RDONLY"
    is_method = isinstance(call.func, ast.Attribute) and not _is_os(call.func.value)
    given = [word.value for word in call.keywords if word.arg == "mode"] or call.args[0 if is_method else 1 :]
    mode = given[0] if given else ast.Constant("r")
    # A method `open` of something else than a path takes no mode.
    return not (
        isinstance(mode, ast.Constant) and isinstance(mode.value, str) and set(mode.value) & set("wax+")
    ) and (is_method or isinstance(mode, ast.Constant))


def test_every_write_and_removal_goes_through_one_room_that_is_seen_and_every_exception_is_one():
    elsewhere = [
        f"{path}:{line}: {name}"
        for path, line, name in _all_calls()
        if not path.startswith("core/files/") and name not in EXCEPTIONS.get(path, {})
    ]
    assert elsewhere == []
    found = {(path, name) for path, _, name in _all_calls()}
    assert {(path, name) for path, names in EXCEPTIONS.items() for name in names} <= found
    found = {name for path, _, name in _all_calls() if path.startswith("core/files/")}
    assert {"mkdir", "rename", "replace", "unlink", "rmdir", "rmtree", "symlink_to", "open"} <= found


@cache
def _all_calls():
    return [
        (path.relative_to(PACKAGE).as_posix(), *call)
        for path in sorted(PACKAGE.rglob("*.py"))
        for call in changing_calls(ast.parse(path.read_text("utf-8")))
    ]
