"""Do the tests bite? Change the program in one place at a time and see whether a test fails.

    python scripts/mutate.py --seed 1 --count 60
    python scripts/mutate.py physics sweeps --count 10 --whole
    python scripts/mutate.py --place src/uictest/core/physics/air.py:30:20:constant

Works in a temporary copy of the checkout, which builds a kernel of its own when a change is one of the model.
Each place is tried with the tests of its module, of its room and of the rooms that use it, until one fails. A
survivor needs a test that fails, or a reason why the change makes no difference.
"""

from __future__ import annotations

import argparse
import ast
import difflib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
PACKAGE = REPOSITORY / "src/uictest"
_TESTS = {
    "analysis": (
        "comparison",
        "validation",
        "sweeps/summaries",
        "firmness",
        "service_log",
        "cli/commands/test_validate.py",
    ),
    "api": ("api", "stepping", "fmu"),
    "controllers": ("controllers", "rig"),
    "core": (
        *(
            "physics",
            "kernel",
            "measures",
            "series_measures",
            "recording",
            "statistics",
            "files",
            "user_cache",
        ),
        *("test_record.py", "test_units.py", "rig", "evaluation", "history"),
    ),
    "judging": ("evaluation", "series"),
    "plans": (
        *("scenario", "series", "sweeps/plan", "validation", "faults", "library", "templates", "rig"),
        *("cli/commands/test_check.py", "cli/commands/test_validate.py"),
    ),
    "recorded": ("field_data", "fitting", "service_log"),
    "report": ("report", "sweeps/summaries"),
    "rig": ("rig", "identification"),
    "running": ("campaign", "sweeps/running"),
    "runs": ("runs", "history", "api"),
    "selftest": ("selftest", "conformance"),
    "units": ("test_units.py",),
}
"""Room -> where its tests are, nearest first, if not only in the folder called as the room."""
_FOLDERS = {
    "analysis/summaries": "sweeps/summaries",
    "plans/sweeps": "sweeps/plan",
    "running/chunked": "sweeps/running",
}
"""Folder of a room -> that of its tests, where it is not called as the folder."""
_ONE_SOURCE = ("test_compiled.py", "test_lanes.py")
"""Tests that hold processors against each other: they run one source, so a change of it shows in none."""
_OTHER_OPERATOR: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
    ast.And: ast.Or,
    ast.Or: ast.And,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
_OTHER_ORDER: dict[type[ast.AST], tuple[type[ast.AST], type[ast.AST]]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
}
_SYMMETRIC = ("minimum", "maximum", "min", "max")


@dataclass(frozen=True)
class Place:
    """A node of the syntax tree of a file, and one way to change it."""

    file: str
    line: int
    column: int
    kind: str
    old: ast.AST
    new: ast.AST

    @property
    def name(self) -> str:
        """What the place is called in the table and by --place."""
        return f"{self.file}:{self.line}:{self.column}:{self.kind}"

    def mutated(self, text: str) -> str:
        """Return the text of the file with the change."""
        lines = text.splitlines(keepends=True)
        old = self.old
        assert isinstance(old, ast.expr | ast.stmt)
        assert old.end_lineno is not None
        assert old.end_col_offset is not None
        before = lines[old.lineno - 1].encode()[: old.col_offset].decode()
        after = lines[old.end_lineno - 1].encode()[old.end_col_offset :].decode()
        new = ast.unparse(self.new)
        if isinstance(self.new, ast.BinOp | ast.BoolOp | ast.Compare | ast.UnaryOp):
            new = f"({new})"
        changed = "".join([*lines[: old.lineno - 1], before, new, after, *lines[old.end_lineno :]])
        ast.parse(changed)
        return changed


def places_in(file: str, text: str) -> Iterator[Place]:
    """Yield every place of a file; docstrings, annotations and f-strings are left alone."""
    for node in _nodes(ast.parse(text)):
        for kind, new in _changes(node):
            assert isinstance(node, ast.expr | ast.stmt)
            yield Place(file, node.lineno, node.col_offset, kind, node, new)


def _nodes(tree: ast.AST) -> Iterator[ast.AST]:
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "decorator_list") or isinstance(tree, ast.JoinedStr):
            continue
        for node in value if isinstance(value, list) else [value]:
            if isinstance(node, ast.AST):
                yield node
                yield from _nodes(node)


def _changes(node: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    """Yield the kind of each change of a node, and the node changed."""
    match node:
        case ast.Compare(ops=[operator]) if type(operator) in _OTHER_ORDER:
            bound, inverted = _OTHER_ORDER[type(operator)]
            yield "bound", _with(node, ops=[bound()])
            yield "inverted", _with(node, ops=[inverted()])
        case ast.Compare(ops=[operator]) if type(operator) in _OTHER_OPERATOR:
            yield "inverted", _with(node, ops=[_OTHER_OPERATOR[type(operator)]()])
        case ast.BinOp(op=operator) | ast.BoolOp(op=operator) if type(operator) in _OTHER_OPERATOR:
            yield "operator", _with(node, op=_OTHER_OPERATOR[type(operator)]())
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            yield "sign", operand
        case ast.Constant(value=bool(value)):
            yield "constant", ast.Constant(not value)
        case ast.Constant(value=int(value)):
            yield "constant", ast.Constant(value + 1)
            yield "twice", ast.Constant(value * 2 or 2)
        case ast.Constant(value=float(value)):
            yield "constant", ast.Constant(value * 1.03 or 0.03)
            yield "twice", ast.Constant(value * 2.0 or 2.0)
        case ast.Call(args=[*others, first, second]) if ast.unparse(node.func) not in _SYMMETRIC:
            yield "swapped", _with(node, args=[*others, second, first])
        case ast.AugAssign() | ast.Expr(value=ast.Call()):
            yield "removed", ast.Pass()
        case ast.Assign(targets=[ast.Attribute() | ast.Subscript()]):
            yield "removed", ast.Pass()


def _with(node: ast.AST, **fields: object) -> ast.AST:
    kept = dict(ast.iter_fields(node))
    return type(node)(**{**kept, **fields})


def rooms() -> list[str]:
    """Return every room of the package that has code: its folders and its single files."""
    names = [path.stem for path in sorted(PACKAGE.iterdir()) if path.suffix in ("", ".py")]
    return [name for name in names if not name.startswith("__") and _files_of(name)]


def _files_of(room: str) -> list[Path]:
    file = PACKAGE / f"{room}.py"
    return [file] if file.is_file() else sorted((PACKAGE / room).rglob("*.py"))


def tests_of(room: str) -> list[str]:
    """Return the folders and files with the tests of a room, nearest first."""
    return [path for each in _TESTS.get(room, (room,)) if (REPOSITORY / (path := f"tests/{each}")).exists()]


def chosen_places(names: Sequence[str], count: int, seed: int) -> list[Place]:
    """Return so many places, the rooms in turn; no two in the same line."""
    generator = random.Random(seed)
    shuffled: dict[str, list[Place]] = {}
    for room in names:
        texts = {path.relative_to(REPOSITORY).as_posix(): path.read_text("utf-8") for path in _files_of(room)}
        shuffled[room] = [place for file, text in texts.items() for place in places_in(file, text)]
        generator.shuffle(shuffled[room])
    chosen: dict[tuple[str, int], Place] = {}
    while len(chosen) < count and any(shuffled.values()):
        for room in names:
            while shuffled[room] and len(chosen) < count:
                place = shuffled[room].pop()
                if chosen.setdefault((place.file, place.line), place) is place:
                    break
    return list(chosen.values())


def named_places(names: Sequence[str]) -> list[Place]:
    """Return the places with the given names. Raises SystemExit for one that is not there."""
    places = []
    for name in names:
        file = name.split(":", 1)[0]
        text = (REPOSITORY / file).read_text("utf-8")
        matching = [place for place in places_in(file, text) if place.name == name]
        if not matching:
            raise SystemExit(f"no such place: {name}; write FILE:LINE:COLUMN:KIND as the table shows it")
        places.append(matching[0])
    return places


def test_stages(place: Place, whole: bool) -> list[list[str]]:
    """Return what is given to pytest, stage by stage: the module's own tests first."""
    module = Path(place.file).relative_to("src/uictest")
    room, _, below = module.parent.as_posix().partition("/")
    for prefix, folder in _FOLDERS.items():
        if f"{room}/{below}".startswith(prefix):
            below = folder
    own = (Path("tests", folder) for folder in (below, room))
    nearest = (path / f"test_{module.stem}.py" for path in own)
    stages = [[str(path)] for path in nearest if (REPOSITORY / path).exists()]
    stages += [[each] for each in tests_of(Path(module.parts[0]).stem)]
    return stages + ([["tests"]] if whole else [])


class Copy:
    """A copy of the checkout in which one file at a time is changed and tests are run."""

    def __init__(self, root: Path, seconds: float) -> None:
        self.root = root
        self._seconds = seconds
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            cwd=REPOSITORY,
            capture_output=True,
            check=True,
        )
        built = [path.relative_to(REPOSITORY).as_posix() for path in PACKAGE.glob("rig/kernel/rig-*")]
        for name in filter(None, [*listed.stdout.decode().split("\0"), *built]):
            if (REPOSITORY / name).is_file():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(REPOSITORY / name, root / name)
        self._environment = {
            **os.environ,
            "PYTHONPATH": str(root / "src"),
            "PYTHONDONTWRITEBYTECODE": "1",
            "UICTEST_CACHE": str(root / ".cache"),
        }

    def verdict(self, place: Place, stages: Sequence[Sequence[str]]) -> str:
        """Return `killed`, `hung` or `survived` for a change, and undo it."""
        path = self.root / place.file
        text = path.read_text("utf-8")
        path.write_text(place.mutated(text), "utf-8")
        try:
            return next(
                (verdict for stage in stages if (verdict := self.run(stage)) != "survived"), "survived"
            )
        finally:
            path.write_text(text, "utf-8")

    def run(self, arguments: Sequence[str]) -> str:
        """Run tests until one fails, at most as long as stated."""
        ignored = [f"--ignore-glob=*/{name}" for name in _ONE_SOURCE]
        options = ["-x", "-q", "-p", "no:cacheprovider", *ignored]
        command = [sys.executable, "-m", "pytest", *options, *arguments]
        process = subprocess.Popen(
            command,
            cwd=self.root,
            env=self._environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        try:
            return "survived" if process.wait(self._seconds) == 0 else "killed"
        except subprocess.TimeoutExpired:
            return "hung"
        finally:
            _end(process)


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a run of tests and what it has started."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _difference(place: Place, text: str) -> str:
    lines = difflib.unified_diff(text.splitlines(), place.mutated(text).splitlines(), n=0, lineterm="")
    return "\n".join(f"    {line}" for line in lines if not line.startswith(("---", "+++", "@@")))


def _try_all(places: Sequence[Place], copy: Copy, whole: bool, report: Callable[[str], object]) -> int:
    """Return how many places survived."""
    survivors = 0
    for place in places:
        begin = time.monotonic()
        difference = _difference(place, (copy.root / place.file).read_text("utf-8"))
        verdict = copy.verdict(place, test_stages(place, whole))
        survivors += verdict == "survived"
        report(f"{verdict:8}  {time.monotonic() - begin:5.0f} s  {place.name}\n{difference}")
    return survivors


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("rooms", nargs="*", metavar="ROOM", help="a room of src/uictest; all of them")
    parser.add_argument("--count", type=int, default=60, help="how many places [60]")
    parser.add_argument("--seed", type=int, default=0, help="of the choice of places [0]")
    parser.add_argument(
        "--place", action="append", default=[], help="FILE:LINE:COLUMN:KIND instead of a choice"
    )
    parser.add_argument("--whole", action="store_true", help="run the whole suite on what survives its rooms")
    parser.add_argument("--no-check", dest="check", action="store_false", help="the tests are known to pass")
    parser.add_argument("--seconds", type=float, default=900.0, help="limit for one run of tests [900]")
    options = parser.parse_args()
    if unknown := set(options.rooms) - set(rooms()):
        parser.error(f"no such room: {', '.join(sorted(unknown))}; there are {', '.join(rooms())}")
    return options


def main() -> int:
    """Try the places and print the table; exit 1 where one survives, 3 where the tests fail unchanged."""
    options = _arguments()
    if options.place:
        places = named_places(options.place)
    else:
        places = chosen_places(options.rooms or rooms(), options.count, options.seed)
    with tempfile.TemporaryDirectory(prefix="uictest-mutate-") as folder:
        copy = Copy(Path(folder), options.seconds)
        stages = {stage[0] for place in places for stage in test_stages(place, options.whole)}
        folders = sorted(stage for stage in stages if not stage.endswith(".py"))
        for tests in folders if options.check else []:
            if copy.run([tests]) != "survived":
                print(f"{tests}: the tests fail, or last too long, without a change", file=sys.stderr)
                return 3
        survivors = _try_all(places, copy, options.whole, lambda line: print(line, flush=True))
    print(f"{len(places)} places, {survivors} survived")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
