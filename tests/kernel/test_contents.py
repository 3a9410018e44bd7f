"""The generated text is the same everywhere and tells its origin; all that it is made from is watched."""

import ast
import ctypes
import os
import re
import subprocess
import sys
from functools import cache
from importlib import import_module
from importlib.util import resolve_name
from pathlib import Path
from types import FunctionType

import pytest

import uictest
from kernel import contents, fmu
from kernel.names import safe
from kernel.syntax import names_set
from uictest.core.record import FieldCopier, FieldStarter, Record
from uictest.rig.kernel import library
from uictest.rig.kernel.library import Entry, processors

REPOSITORY = Path(__file__).parents[2]


@pytest.fixture(name="program", scope="module")
def _program():
    return contents.written()


def test_another_process_writes_the_same_text(program, tmp_path):
    command = [sys.executable, REPOSITORY / "kernel" / "build.py", "--write", tmp_path]
    for seed in ("1", "2"):
        subprocess.run(command, check=True, capture_output=True, env={**os.environ, "PYTHONHASHSEED": seed})
        assert (tmp_path / "rig.cpp").read_text("utf-8") == program.text()


@cache
def tree_of(path):
    return ast.parse(Path(path).read_text("utf-8"))


def test_every_statement_has_its_line_and_every_function_and_variable_its_name(program):
    places = set(re.findall(r'#line (\d+) "(\S+)"', program.text()))
    words = set(re.findall(r"\w+", program.text()))
    functions = [each for each in program.names if isinstance(each, FunctionType)]
    assert len(functions) > 300
    for function in functions:
        code = function.__code__
        file = Path(code.co_filename).relative_to(REPOSITORY).as_posix()
        [tree] = [
            each
            for each in ast.walk(tree_of(code.co_filename))
            if isinstance(each, ast.FunctionDef) and each.lineno == code.co_firstlineno
        ]
        statements = {each for each in ast.walk(tree) if isinstance(each, ast.stmt)} - {tree, tree.body[0]}
        assert {(str(each.lineno), file) for each in statements} <= places
        assert {safe(name) for name in (code.co_name, *code.co_varnames)} - {"_"} <= words


def file_of(module):
    return import_module(module).__spec__.origin


def follow(module, name, seen):
    """Add to what is seen the names that decide a name of a module: where it is from, what it is made of."""
    if (module, name) in seen or not module.startswith("uictest"):
        return
    seen.add((module, name))
    stub = Path(file_of(module)).with_suffix(".pyi")  # says where a room that loads late has its names from
    for node in tree_of(stub if stub.exists() else file_of(module)).body:
        match node:
            case ast.ImportFrom():
                origin = resolve_name("." * node.level + (node.module or ""), module)
                for each in node.names:
                    if name == (each.asname or each.name):
                        follow(origin, each.name, seen)
            case ast.Assign(value=value) | ast.AnnAssign(value=ast.expr() as value):
                if name in names_set(node):
                    for each in ast.walk(value):
                        if isinstance(each, ast.Name):
                            follow(module, each.id, seen)


def test_whatever_is_read_is_among_the_sources(program):
    """Else code of before would run after a change."""
    used = {tuple(each.function.split(":")) for each in contents.ENTRIES}
    used |= {(each.__module__, each.__name__) for each in records()}
    for each in program.names:
        match each:
            case FieldCopier() | FieldStarter():
                used.add((each.record.__module__, each.record.__name__))
            case (str(), str()):
                used.add(each)
            case FunctionType() | type():
                used.add((each.__module__, each.__name__))
    seen = set()
    for module, name in used:
        follow(module, name, seen)
    files = {file_of(module) for module, _ in seen if not Path(file_of(module)).with_suffix(".pyi").exists()}
    # Other tests of this process may have added controllers of their own.
    files = {each for each in files if Path(each).is_relative_to(library.PACKAGE)}
    assert len(files) > 30
    assert files <= set(library.sources())


def records(kind=Record):
    """Yield all records of the package that are loaded: their fields are the layouts."""
    for each in kind.__subclasses__():
        yield each
        yield from records(each)


def test_the_sources_are_there_and_each_is_named_once():
    sources = list(library.sources())
    assert len(set(sources)) == len(sources) > 50
    assert all(Path(each).suffix == ".py" and Path(each).is_file() for each in sources)


def test_every_function_that_the_package_calls_is_an_entry_and_exported():
    called = set()
    for path in (Path(uictest.__file__).parent / "rig").rglob("*.py"):
        module = "uictest." + path.relative_to(Path(uictest.__file__).parent).as_posix()[:-3].replace(
            "/", "."
        )
        if "Entry(" in path.read_text("utf-8"):
            named = vars(import_module(module)).values()
            called |= {each.function for each in named if isinstance(each, Entry)}
    of_fmus = {each.function for _, each in fmu.CALLED.values()}
    assert called and called <= {each.function for each in contents.ENTRIES} | of_fmus
    exported = library._library()
    for each in contents.ENTRIES:
        for level in processors():
            assert ctypes.cast(getattr(exported, f"{each.symbol}_{level}"), ctypes.c_void_p).value
