"""Whether all that the program writes and prints is what it was at another revision, byte for byte.

    python scripts/same_outputs.py REVISION              # after a change that is to change no output
    python scripts/same_outputs.py REVISION -k sweep     # only groups of commands in which this word stands

Runs the commands of `same_outputs.yaml` with the present tree, uncommitted changes included, and with a
temporary work tree of REVISION. Prints for each file, and for the text of each command, that differs its name
and the beginning of the difference. Exit code 1 if any does.

Each side uses its own scenarios/ and examples/, and the packages of the interpreter that runs this script,
which must have those of `.[dev]`. A side takes some five minutes of a processor. What a revision put out is
kept in the user's cache, or in `--keep FOLDER`, by commit, commands and versions of the packages, and used
again: a second comparison runs only the present tree. The folder can be removed at any time.

What cannot be the same twice (times, durations, paths, the version of the program) is replaced, by the rules
in `output_contents.py` and nowhere else. Of workbooks, archives and recordings whose bytes differ the cells,
members and channels are compared; in SHA256SUMS stands for a digest whether it is right. All else counts:
digests of inputs and parts, names of files, exit codes, the order of rows.
"""

from __future__ import annotations

import argparse
import difflib
import hashlib
import os
import pty
import shutil
import subprocess
import sys
import tempfile
import tomllib
import venv
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import metadata
from itertools import takewhile
from pathlib import Path
from typing import Any, Final

import yaml
from output_contents import REPOSITORY, SCRATCH, content, steady

COMMANDS: Final = Path(__file__).with_suffix(".yaml")
_TERMINAL: Final = "$TTY "
_LONGEST: Final = 900  # s for one command
_SHOWN: Final = 20  # lines of a difference
_WIDTH: Final = 160  # characters of a line of it
_BUILT: Final = shutil.ignore_patterns("*.so", "*.fmu", "__pycache__")
Groups = Mapping[str, Mapping[str, Any]]


def put_out(tree: Path, groups: Groups, folders: Mapping[str, Path], scratch: Path) -> Iterator[str]:
    """Run with the program in `tree` the groups that have no folder of outputs yet; yield their names."""
    missing = [name for name in groups if not folders[name].is_dir()]
    if not missing:
        return
    variables = _variables(tree, scratch)
    for name in missing:
        began = _processor_time()
        outputs = _outputs_of(groups[name], tree, variables, scratch)
        partial = folders[name].with_suffix(".partial")
        shutil.rmtree(partial, ignore_errors=True)
        partial.parent.mkdir(parents=True, exist_ok=True)
        shutil.move(outputs, partial)
        partial.rename(folders[name])
        print(f"{tree.name}: {name}: {_processor_time() - began:.0f} s of a processor", file=sys.stderr)
        yield name


def _processor_time() -> float:
    times = os.times()
    return times.children_user + times.children_system


def _outputs_of(group: Mapping[str, Any], tree: Path, variables: dict[str, str], scratch: Path) -> Path:
    """Run the commands of a group in a new folder; return a folder with all that they print and write."""
    outputs, work = scratch / "outputs", scratch / "work"
    shutil.rmtree(outputs, ignore_errors=True)
    (outputs / "texts").mkdir(parents=True)
    for name in ("scenarios", "examples"):
        shutil.copytree(tree / name, work / name, ignore=_BUILT)
    for name, text in group.get("files", {}).items():
        (work / name).write_text(text, "utf-8")
    inputs = {path: path.read_bytes() for path in work.rglob("*") if path.is_file()}
    for number, command in enumerate(group["commands"].splitlines(), 1):
        text = f"$ {command}\n{_text_of(command, work, variables)}"
        (outputs / "texts" / f"{number:02}").write_text(text, "utf-8")
    for path, before in inputs.items():
        if path.is_file() and path.read_bytes() == before:
            path.unlink()
    shutil.move(work, outputs / "files")
    return outputs


def _text_of(command: str, folder: Path, variables: dict[str, str]) -> str:
    if command.startswith(_TERMINAL):
        return _text_on_terminal(command.removeprefix(_TERMINAL), folder, variables)
    done = subprocess.run(
        ["sh", "-c", command],
        cwd=folder,
        env=variables,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=False,
        timeout=_LONGEST,
    )
    out, err = (stream.decode("utf-8", "backslashreplace") for stream in (done.stdout, done.stderr))
    return f"--- stdout\n{out}--- stderr\n{err}--- exit code {done.returncode}\n"


def _text_on_terminal(command: str, folder: Path, variables: dict[str, str]) -> str:
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        ["sh", "-c", command], cwd=folder, env=variables, stdin=theirs, stdout=theirs, stderr=theirs
    ) as process:
        os.close(theirs)
        shown = b"".join(iter(lambda: _read(ours), b""))
        code = process.wait(_LONGEST)
    os.close(ours)
    # Bars of progress leave blank lines, more or fewer.
    lines = [line for line in shown.decode().splitlines() if line.strip()]
    return "\n".join(["--- terminal", *lines, f"--- exit code {code}", ""])


def _read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 4096)
    except OSError:  # what Linux says when the other end has closed
        return b""


def _variables(tree: Path, scratch: Path) -> dict[str, str]:
    """Return the variables of commands for which `uictest`, `reproduce` and `python` are those of the tree.

    They have an environment of their own: some processes of the program ignore PYTHONPATH.
    """
    place = scratch / f"environment-{tree.name}"
    venv.EnvBuilder(symlinks=True).create(place)
    packages = next(place.glob("lib/python*/site-packages"))
    ours = [entry for entry in sys.path if entry.endswith("site-packages")]
    (packages / "tree.pth").write_text("\n".join([str(tree / "src"), str(tree), *ours, ""]))
    script = tomllib.loads((tree / "pyproject.toml").read_text("utf-8"))["project"]["scripts"]["uictest"]
    module, _, function = script.partition(":")
    program = place / "bin/uictest"
    program.write_text(f"#!{place}/bin/python\nfrom {module} import {function}\n\n{function}()\n")
    program.chmod(0o755)
    # A revision whose studies are in the package has them as a command of the program.
    beside = (tree / "studies/__main__.py").is_file()
    studies = f"{place}/bin/python -m studies" if beside else f"{program} reproduce"
    reproduce = place / "bin/reproduce"
    reproduce.write_text(f'#!/bin/sh\nexec {studies} "$@"\n')
    reproduce.chmod(0o755)
    kept = {name: os.environ[name] for name in ("HOME", "UICTEST_CACHE", "CC") if name in os.environ}
    fixed = {"LC_ALL": "C.UTF-8", "TZ": "UTC", "TERM": "dumb", "COLUMNS": "110", "MPLBACKEND": "agg"}
    return {**kept, **fixed, "PATH": f"{place / 'bin'}{os.pathsep}{os.environ['PATH']}"}


def compared(group: str, one: Path, other: Path, told: dict[tuple[str, ...], str]) -> tuple[int, int, int]:
    """Print what differs between two folders of outputs; return the number of files, texts and differences.

    `told` holds the differences that are printed already, each with the output that has it.
    """
    before, now = _named(one), _named(other)
    different = 0
    for name in sorted({**before, **now}):
        if name in before and name in now:
            lines = difference(before[name], now[name])
        else:
            lines = [f"+ only {'now' if name in now else 'before'}"]
        if lines:
            different += 1
            changed = tuple(line for line in lines if line.startswith(("+", "-")))
            command = now[name].read_text("utf-8").splitlines()[0] if name.startswith("texts/") else ""
            shown = [f"as in {told[changed]}"] if changed in told else [*lines, ""]
            print("\n".join([f"{group}/{name} {command}".rstrip(), *shown]))
            told.setdefault(changed, f"{group}/{name}")
    texts = sum(name.startswith("texts/") for name in now)
    return len(now) - texts, texts, different


def _named(folder: Path) -> dict[str, Path]:
    """Return the files and links below a folder by name, without what cannot be the same in it."""
    found: dict[str, Path] = {}
    for place, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if name != "__pycache__"]
        links = [name for name in folders if Path(place, name).is_symlink()]
        for path in sorted(Path(place, name) for name in (*files, *links)):
            name = steady(path.relative_to(folder).as_posix())
            while name in found:
                name += " (another)"
            found[name] = path
    return found


def difference(one: Path, other: Path) -> list[str]:
    """Return the beginning of the difference between two outputs; nothing if they are the same."""
    if not (one.is_symlink() or other.is_symlink()) and one.read_bytes() == other.read_bytes():
        return []
    first, second = (steady(content(path)) for path in (one, other))
    if first == second:
        return []
    before, now = (list(_lines(text)) for text in (first, second))
    same = len(list(takewhile(lambda pair: pair[0] == pair[1], zip(before, now, strict=False))))
    # Only what follows the first difference is compared: whole pages would take minutes.
    part = slice(max(same - 1, 0), same + 10 * _SHOWN)
    return list(difflib.unified_diff(before[part], now[part], n=1, lineterm=""))[3 : 3 + _SHOWN]


def _lines(text: str) -> Iterator[str]:
    for line in text.replace("><", ">\n<").split("\n"):
        yield from (line[at : at + _WIDTH] for at in range(0, max(len(line), 1), _WIDTH))


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if all outputs are the same, 1 if not."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("revision", help="as git names it")
    parser.add_argument("-k", metavar="WORD", default="", help="only groups with WORD in name or commands")
    parser.add_argument("--keep", metavar="FOLDER", type=Path, help="for the outputs of revisions")
    options = parser.parse_args(arguments)
    commit = _git("rev-parse", "--verify", f"{options.revision}^{{commit}}")
    groups = _groups(options.k)
    cache = Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "uictest-same-outputs"
    kept = (options.keep or cache).absolute() / commit[:12]
    packages = sorted({f"{each.name} {each.version}" for each in metadata.distributions()})
    folders = {name: kept / f"{name}-{_digest(sys.version, packages, groups[name])}" for name in groups}
    with tempfile.TemporaryDirectory(prefix=SCRATCH) as folder:
        scratch = Path(folder).resolve()
        if not all(place.is_dir() for place in folders.values()):
            with _work_tree(commit, scratch / "tree") as tree:
                list(put_out(tree, groups, folders, scratch))
        present = {name: scratch / "present" / name for name in groups}
        told: dict[tuple[str, ...], str] = {}
        counts = []
        for name in put_out(REPOSITORY, groups, present, scratch):
            counts.append(compared(name, folders[name], present[name], told))
            shutil.rmtree(present[name])
    files, texts, different = (sum(column) for column in zip(*counts, strict=True))
    print(f"{files} files and {texts} texts: {f'{different} differ' if different else 'same'}")
    return 1 if different else 0


def _groups(word: str) -> Groups:
    everything: Groups = yaml.safe_load(COMMANDS.read_text("utf-8"))
    chosen = {
        name: each
        for name, each in everything.items()
        if word in f"{name}\n{each['commands']}" and (word or not each.get("on_request"))
    }
    if not all(map(shutil.which, ("cc", "make"))):
        without = [name for name, each in chosen.items() if each.get("compilers")]
        print(f"no cc and make, left out: {', '.join(without)}", file=sys.stderr)
        chosen = {name: each for name, each in chosen.items() if name not in without}
    if not chosen:
        raise SystemExit(f"no group of commands to run has {word!r}")
    return chosen


def _digest(*values: object) -> str:
    return hashlib.sha256(repr(values).encode()).hexdigest()[:12]


@contextmanager
def _work_tree(commit: str, place: Path) -> Iterator[Path]:
    _git("worktree", "add", "--detach", "--quiet", str(place), commit)
    try:
        yield place
    finally:
        _git("worktree", "remove", "--force", str(place))


def _git(*words: str) -> str:
    command = ["git", "-C", str(REPOSITORY), *words]
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE).stdout.strip()


if __name__ == "__main__":
    sys.exit(main())
