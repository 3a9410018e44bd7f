"""What the generator does not take it refuses with place, code and remedy, or the compiler does."""

import itertools
import re
import sys
from importlib.util import module_from_spec, spec_from_file_location

import pytest

from kernel import alone, build, contents
from kernel.names import UntranslatableError

from .conftest import exported

HEAD = """
import decimal
import math
from typing import NamedTuple
from uictest.core.physics.arithmetic import maximum, select

LIMIT = 2.5
NAME = "rail"
TABLE = (1.0, 2.0)
LARGE = 2**70
class Pair(NamedTuple):
    first: float
    second: float = 1.0
def twice(a):
    return 2.0 * a
def changed(record):
    record.x = record.x + 1.0
    return record.x
"""
HEAD_OF_F = "def f(a: float, b: float, m: int) -> float:"
REFUSED = {
    "comprehension": ("return twice([x for x in TABLE])", "[x for x in TABLE]"),
    "lambda": ("g = lambda x: x", "lambda x: x"),
    "inner function": ("def g(): return a", "def g():"),
    "keyword": ("return maximum(a, b=b)", "maximum(a, b=b)", "calls without keywords"),
    "power": ("return a ** 2", "a ** 2", "products in place of powers"),
    "product of matrices": ("return a @ b", "a @ b"),
    "try": ("try:\n  b = a\nexcept ValueError: pass", "try:"),
    "with": ("with a: b = a", "with a:"),
    "raise": ("raise ValueError(a)", "raise ValueError(a)"),
    "assert": ("assert a > b", "assert a > b"),
    "pass": ("if a > b: pass", "pass"),
    "delete": ("del a", "del a"),
    "match": ("match m:\n  case 1: return a", "match m:"),
    "walrus": ("return (c := a) + b", "(c := a)"),
    "else of while": ("while a > b: a = b\nelse: b = a", "while a > b:"),
    "else of for": ("for i in range(m): a = b\nelse: b = a", "for i in range(m):"),
    "range of three": ("for i in range(0, m, 2): a = b", "for i in range(0, m, 2):", "one bound or two"),
    "loop over an array": ("for x in a: b = x", "for x in a:", "range"),
    "loop over negative numbers": ("for x in (1.0, -1.0): b = x", "for x in (1.0, -1.0):"),
    "loop with two names": ("for i, j in a: b = i", "for i, j in a:"),
    "own range": ("range = twice\nfor i in range(m): a = b", "twice"),
    "open slice": ("return twice(a[1:])", "a[1:]", "both bounds of a slice"),
    "slice with a step": ("return twice(a[0:4:2])", "a[0:4:2]", "no step"),
    "index from the end": ("return a[-1]", "-1", "an index counted from the front"),
    "slice from the end": ("return twice(a[0:-1])", "-1", "an index counted from the front"),
    "copy of a slice": ("a[0:2] = b[0:2]\nreturn 1.0", "a[0:2]", "single members on the left"),
    "starred call": ("return maximum(*twice(a))", "*twice(a)", "a tuple that is written down"),
    "starred target": ("c, *d = a, b, 1.0", "(c, *d)"),
    "members of another number": ("c, d = a, b, 1.0", "(c, d)", "3 names on the left"),
    "string": ("return twice('rail')", "'rail'"),
    "string of the module": ("return twice(NAME)", "NAME", "a number or a tuple of numbers"),
    "large number": ("return a + 9223372036854775808", "9223372036854775808"),
    "large number of the module": ("return a + LARGE", "LARGE", "a number or a tuple of numbers"),
    "function of another library": ("return math.sin(a)", "math.sin(a)", "of this package"),
    "class of another library": ("return decimal.Decimal(a)", "decimal.Decimal(a)"),
    "builtin that C++ has not": ("return min(a, b)", "min(a, b)"),
    "method": ("return a.sum()", "a.sum()"),
    "unknown name": ("return a + nothing", "nothing", "a variable or a constant of the module"),
    "attribute that a module has not": ("return a + math.nothing", "math", "a number"),
    "class as a number": ("return a + Pair.first", "Pair", "a number"),
    "tuple with a default": ("return Pair(a).second", "Pair(a)"),
    "is": ("return a if a is b else b", "a is b"),
    "in": ("return a if a in TABLE else b", "a in TABLE"),
    "called twice in a chain": (
        "return 1.0 if a < twice(b) < 3.0 else 2.0",
        "a < twice(b) < 3.0",
        "variables in the middle",
    ),
    "set on one path": ("if a > b: c = a\nreturn c", "c", "`c = ...` before, on every path"),
    "set in a loop": ("for i in range(m): c = a\nreturn c", "c", "`c = ...` before, on every path"),
    "set in a while": ("while a > b:\n  c = a\n  a = b\nreturn c", "c", "`c = ...` before, on every path"),
    "read in the next turn": ("for i in range(m):\n  if i > 0: a = c\n  c = b\nreturn a", "c"),
    "added to nothing": ("c += a\nreturn c", "c", "`c = ...` before"),
    "a constant for a variable": ("if a > b: LIMIT = a\nreturn LIMIT", "LIMIT", "`LIMIT = ...` before"),
    "set together in branches": (
        "if a > b: c, d = a, b\nelse: c, d = b, a\nreturn c",
        "if a > b:",
        "`c = ...` before it",
    ),
    "loop variable behind the loop": ("for i in range(m): a = b\nreturn i * a", "i", "`i = ...` before"),
    "loop variable of before": (
        "i = 7\nfor i in range(m): a = b\nreturn i * a",
        "for i in range(m):",
        "a name that only this loop sets",
    ),
    "loop variable that is changed": ("for i in range(m): i += 1", "for i in range(m):", "only at its head"),
    "argument as loop variable": ("for m in range(3): a = b", "for m in range(3):", "only this loop"),
    "no value at the end": ("if a > b: return a", HEAD_OF_F, "at the end of every path"),
    "dead code": ("return a\nb = a", "b = a", "nothing behind `return`"),
    "number in a truth": ("c = a > b\nc = m\nreturn a if c else b", "m", "`bool(...)` around it"),
    "sum of truths": ("return (a > b) + (a > 1.0)", "(a > b) + (a > 1.0)", "select(..., 1, 0)"),
    "complement of a truth": ("return a if ~(a > b) else b", "~(a > b)"),
    "global": ("global LIMIT\nreturn a", "global LIMIT"),
    "yield": ("yield a", "yield a"),
    "text": ("return twice(f'{a}')", "f'{a}'"),
}
DOES_NOT_COMPILE = {
    "operand of `and` as a number": "c = a and b\nreturn c",
    "operand of `or` as a number": "return float(m or 3)",
    "float in a variable for whole numbers": "c = 1\nif a > b: c = a\nreturn c",
    "float in a variable for whole numbers, added": "c = 1\nc += a\nreturn c",
    "truth of a float": "return a if b else 1.0",
    "remainder of floats": "return a % b",
    "whole part of a division of floats": "return a // b",
    "shifted float": "return a << 2",
    "maximum of floats": "return max(a, b)",
    "equal tuples": "return 1.0 if (a, b) == (b, a) else 2.0",
    "member that a tuple has not": "c = (a, b)\nreturn c[2]",
    "tuple of one": "c = (a,)\nreturn c[0]",
    "unpacked too few": "c, d = three(a)\nreturn c",
    "two kinds of values": "return both_kinds(a)",
    "large number that meets a float": "return a * 9223372036854775807",
    "copy of a row": "return row(TABLE)",
    "too many arguments": "return twice(a, b)",
    "values of a procedure": "return nothing(a)",
}
MORE = (
    HEAD
    + """
def three(a):
    return (a, a, a)
def both_kinds(a):
    if a > 1.0:
        return a
    return a > 0.0
def row(table):
    other = (table[0], table[1])
    other[0:1][0] = 1.0
    return other[0]
def nothing(a):
    b = a
"""
)


@pytest.fixture(name="functions")
def _functions(tmp_path, monkeypatch):
    """Make a module of some source and return the names in it."""
    numbers = itertools.count()

    def functions(source):
        name = f"snippet_{next(numbers)}"
        path = tmp_path / f"{name}.py"
        path.write_text(source, "utf-8")
        spec = spec_from_file_location(name, path)
        module = module_from_spec(spec)
        monkeypatch.setitem(sys.modules, name, module)
        spec.loader.exec_module(module)
        return module

    return functions


def function_with(body, head=HEAD):
    lines = "".join(f"    {line}\n" for line in body.splitlines())
    return f"{head}{HEAD_OF_F}\n{lines}"


def refusal_of(function):
    with pytest.raises(UntranslatableError) as caught:
        contents.begun().function(function)
    return str(caught.value)


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_taken_is_refused(functions, name):
    body, code, *remedy = REFUSED[name]
    source = function_with(body)
    message = refusal_of(functions(source).f)
    found = re.fullmatch(r"snippet_0\.py:(\d+): `(.*)` cannot be compiled; write (.*)", message)
    assert found, message
    line, quoted, instead = found.groups()
    assert quoted == code
    first = code.partition("\n")[0].rstrip(":").split("=")[0].strip("() ~`")
    assert first in source.splitlines()[int(line) - 1].replace('"', "'")
    assert (remedy[0] if remedy else "") in instead


@pytest.mark.parametrize("name", DOES_NOT_COMPILE)
def test_what_the_types_forbid_does_not_compile(functions, name, tmp_path):
    program = contents.begun()
    exported(program, functions(function_with(DOES_NOT_COMPILE[name], MORE)).f)
    with pytest.raises(build.BuildError, match=r": error: ") as refused:
        alone.load(program, tmp_path)
    assert re.search(r"snippet_0\.py:\d+:\d+: ", str(refused.value))


@pytest.mark.parametrize(
    ("source", "told"),
    {
        "default": ("def f(a=1.0):\n    return a", "arguments by position only, without defaults"),
        "any number of arguments": ("def f(*a):\n    return a", "arguments by position only"),
        "keyword": ("def f(*, a):\n    return a", "arguments by position only"),
        "decorator": (
            "def as_it_is(g): return g\n@as_it_is\ndef f(a):\n    return a",
            "a plain function of a module: no decorator, no closure",
        ),
        "closure": (
            "def outer(b):\n    def g(a):\n        return a + b\n    return g\nf = outer(1.0)",
            "a plain function of a module: no decorator, no closure",
        ),
        "recursion": ("def f(a):\n    return f(a)", "calls itself; write a loop"),
        "recursion of two": ("def f(a):\n    return g(a)\ndef g(a):\n    return f(a)", "calls itself"),
        "made by exec": ("exec('def f(a):\\n    return a')", "f is not written there; write it as a `def`"),
        "lambda": ("f = lambda a: a", "<lambda> is not written there; write it as a `def`"),
        "asynchronous": ("async def f(a):\n    return a", "f is not written there"),
    }.values(),
)
def test_functions_of_other_kinds_are_refused(functions, source, told):
    message = refusal_of(functions(source).f)
    assert re.match(r"(snippet_0\.py|.*/snippet_0\.py|<string>):\d+: ", message)
    assert told in message


OBEYED = {
    "power": "return a * a",
    "keyword": "return maximum(a, b)",
    "large number of the module": "return a + LIMIT",
    "called twice in a chain": "c = twice(b)\nreturn 1.0 if a < c < 3.0 else 2.0",
    "set on one path": "c = 0.0\nif a > b: c = a\nreturn c",
    "set in a loop": "c = 0.0\nfor i in range(m): c = a\nreturn c",
    "added to nothing": "c = 0.0\nc += a\nreturn c",
    "a constant for a variable": "LIMIT = 1.0\nif a > b: LIMIT = a\nreturn LIMIT",
    "set together in branches": "c = 0.0\nif a > b: c, d = a, b\nelse: c, d = b, a\nreturn c",
    "loop variable of before": "i = 7\nfor j in range(m): a = b\nreturn i * a",
    "loop variable behind the loop": "i = 7\nfor j in range(m): i = j\nreturn i * a",
    "no value at the end": "if a > b: return a\nreturn b",
    "number in a truth": "c = a > b\nc = bool(m)\nreturn a if c else b",
    "sum of truths": "return float(select(a > b, 1, 0) + select(a > 1.0, 1, 0))",
    "members of another number": "c, d, e = a, b, 1.0\nreturn c + d + e",
    "starred call": "c = (a, b)\nreturn maximum(*c)",
}


def test_a_remedy_that_is_obeyed_works(functions, tmp_path):
    program = contents.begun()
    assert OBEYED.keys() <= REFUSED.keys()
    for number, body in enumerate(OBEYED.values()):
        module = functions(function_with(body).replace("def f(", f"def f_{number}("))
        exported(program, getattr(module, f"f_{number}"))
    alone.load(program, tmp_path)
