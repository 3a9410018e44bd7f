"""Only machine code of these sources, whole, is run; a checkout builds it anew, an installation says so."""

import os
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import uictest
from kernel import build
from uictest.rig import STEP
from uictest.rig.kernel import library
from uictest.rig.kernel.arguments import at
from uictest.rig.kernel.library import Entry, processor, processors

PACKAGE = Path(uictest.__file__).parent
CHECKOUT = PACKAGE.parents[1]
WHICH = "from uictest.rig.kernel.library import processor; print(processor())"
STOP = """
from pathlib import Path
from uictest.plans.scenario import load
from uictest.rig import simulate
stop = simulate(load([Path("stop.yaml")])[0])
print(stop.measures.braking_distance, stop.measures.tobytes().hex(), stop.wheelset_measures.tobytes().hex())
"""
SCENARIO = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 20 km/h\nrail: {condition: wet}\n"
TORQUE = "return calipers * pads * pad_friction * clamping_force * mean_radius"


class Copy:
    """A copy of the package, as it is installed or, with the programs that build the kernel, checked out."""

    def __init__(self, root, checkout):
        self.root, self.package = root, root / "src" / "uictest"
        shutil.copytree(PACKAGE, self.package, ignore=shutil.ignore_patterns("*.pyc"))
        if checkout:
            for name in ("kernel", "pyproject.toml"):
                source = CHECKOUT / name
                copy = shutil.copytree if source.is_dir() else shutil.copy
                copy(source, root / name)
        (root / "stop.yaml").write_text(SCENARIO, "utf-8")

    def run(self, program, **environment):
        """Run a program on the copy and return what it has done."""
        search = {"PYTHONPATH": str(self.root / "src"), "PYTHONDONTWRITEBYTECODE": "1"}
        return subprocess.run(
            [sys.executable, "-c", program],
            cwd=self.root,
            env={**os.environ, **search, **environment},
            capture_output=True,
            text=True,
            check=False,
        )

    def change(self, name, old, new):
        """Change a file of the package."""
        path = self.package / name
        text = path.read_text("utf-8")
        assert text.count(old) == 1
        path.write_text(text.replace(old, new), "utf-8")

    @property
    def library(self):
        """The one library that it has."""
        [path] = (self.package / "rig" / "kernel").glob("rig-*")
        return path


@pytest.fixture(name="installed")
def _installed(tmp_path):
    return Copy(tmp_path, checkout=False)


@pytest.fixture(name="checkout")
def _checkout(tmp_path):
    return Copy(tmp_path, checkout=True)


def refusal(copy, program=WHICH, **environment):
    """Return the message of what could not be run."""
    done = copy.run(program, **environment)
    assert done.returncode == 1, done.stderr
    assert done.stdout == ""
    found = re.search(r"\S*KernelError: (.*)", done.stderr, re.DOTALL)
    assert found, done.stderr
    return found.group(1).strip()


def test_an_installation_runs_without_the_builder_and_writes_nothing(installed):
    before = sorted(installed.root.rglob("*"))
    done = installed.run(STOP)
    assert float(done.stdout.split()[0]) > 10.0, done.stderr
    assert sorted(installed.root.rglob("*")) == before
    assert done.stderr == ""


def test_without_a_library_an_installation_says_to_install_anew(installed):
    installed.library.unlink()
    told = refusal(installed)
    assert re.search(
        r"rig/kernel has no machine code for \S+ \S+; reinstall uictest from its wheel or sources: pip ", told
    )
    command = "import sys; from uictest.cli.entry import execute; sys.exit(execute(['selftest']))"
    done = installed.run(command)
    assert (done.returncode, done.stderr) == (3, f"uictest: {told}\n")


@pytest.mark.parametrize("name", ["core/physics/brakes.py", "rig/model/state.py", "plans/faults.py"])
def test_an_installation_whose_sources_were_changed_runs_no_old_code(installed, name):
    with (installed.package / name).open("a", encoding="utf-8") as file:
        file.write("# changed\n")
    assert re.search(r"are not those that \S+rig-\S+ was built from; reinstall", refusal(installed))


@pytest.mark.parametrize(
    "damage",
    {
        "empty": lambda code: b"",
        "cut in half": lambda code: code[: len(code) // 2],
        "one byte": lambda code: code[:5000] + bytes([code[5000] ^ 1]) + code[5001:],
        "longer": lambda code: code + b"\0",
    }.values(),
)
def test_a_damaged_library_is_not_loaded(installed, damage):
    path = installed.library
    path.write_bytes(damage(path.read_bytes()))
    assert re.search(r"rig-\S+ is damaged; reinstall uictest", refusal(installed))


def test_no_single_flipped_bit_is_run(installed):
    rig = library.RIG._replace(folder=installed.package / "rig" / "kernel")
    path = installed.library
    code = bytearray(path.read_bytes())
    assert rig.fitting() == path
    for place in range(0, len(code), len(code) // 60):
        code[place] ^= 1
        path.write_bytes(code)
        assert rig.fitting() is None, place
        code[place] ^= 1


def test_threads_that_need_it_at_once_build_it_once(tmp_path, monkeypatch):
    whole, rig, builds = library.RIG.path(), library.RIG._replace(folder=tmp_path), []

    def build(self):
        builds.append(self)
        time.sleep(0.1)
        shutil.copy(whole, tmp_path)
        return self.fitting()

    monkeypatch.setattr(library.Built, "_built", build)
    with ThreadPoolExecutor(2) as threads:
        paths = set(threads.map(lambda _: rig.path(), range(2)))
    assert (paths, len(builds)) == ({tmp_path / whole.name}, 1)


def test_a_checkout_without_the_compiler_says_how_to_build_whatever_was_changed(checkout):
    with (checkout.root / "kernel" / "cpp.py").open("a", encoding="utf-8") as file:
        file.write("# changed\n")
    told = refusal(checkout, f"import sys; sys.modules['ziglang'] = None\n{WHICH}")
    assert told.startswith(
        f"the files in {checkout.package} and {checkout.root / 'kernel'} are not those that "
    )
    checkout.change("core/physics/brakes.py", TORQUE, f"{TORQUE} * 1.1")
    assert told.endswith(f"was built from; build it: pip install --editable '{checkout.root}[build]'")


def test_a_checkout_names_the_formula_that_cannot_be_compiled(checkout):
    checkout.change("core/physics/brakes.py", TORQUE, f"{TORQUE} ** 2")
    told = refusal(checkout)
    text = (checkout.package / "core/physics/brakes.py").read_text("utf-8")
    line = text[: text.index(TORQUE)].count("\n") + 1
    assert told.startswith("the kernel cannot be built:\n")
    assert f"brakes.py:{line}: `mean_radius ** 2` cannot be compiled; write products" in told
    checkout.change("core/physics/brakes.py", f"{TORQUE} ** 2", f"{TORQUE} + nothing")
    assert f"brakes.py:{line}: `nothing` cannot be compiled" in refusal(checkout)


def test_what_was_changed_while_it_was_built_does_not_pass_for_either(checkout):
    """It may be of what the files were before, and once had the name of what they are after."""
    before = sorted(checkout.library.parent.glob("rig-*"))
    built = """
from kernel import build
from uictest.rig.kernel import library
def compiled(target, folder):
    with open(next(library.sources()), "a") as file:
        file.write("# changed")
    return []
build.compile_kernel = compiled
build.build_package()
"""
    done = checkout.run(f"import sys; sys.path.insert(0, {str(checkout.root)!r}){built}")
    assert "BuildError: Python files were changed while they were compiled; build again" in done.stderr
    assert sorted(checkout.library.parent.glob("rig-*")) == before


@pytest.mark.slow
def test_a_checkout_builds_the_changed_formula_in_every_process_that_needs_it(checkout):
    """Two that begin at once both run the new one, and the next finds it there."""
    before = checkout.run(STOP).stdout.split()
    checkout.change("core/physics/brakes.py", TORQUE, f"{TORQUE} * 1.1")
    search = {"PYTHONPATH": str(checkout.root / "src")}
    both = [
        subprocess.Popen(
            [sys.executable, "-c", STOP],
            cwd=checkout.root,
            env={**os.environ, **search},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for _ in range(2)
    ]
    ends = [each.communicate() for each in both]
    third = checkout.run(STOP)
    assert {printed for printed, _ in ends} == {third.stdout}
    assert float(third.stdout.split()[0]) < 0.97 * float(before[0])
    told = r"uictest: building the kernel \.\.\. \d+\.\d s\n"
    assert all(re.fullmatch(told, said) for _, said in ends)
    assert third.stderr == ""
    assert checkout.library.exists()


@pytest.mark.parametrize("level", [level for level in processors() if level != processor()])
def test_the_code_for_another_processor_gives_the_same_bits(installed, level):
    own, other = installed.run(STOP), installed.run(STOP, UICTEST_PROCESSOR=level)
    assert own.stdout == other.stdout != "", other.stderr


@pytest.mark.parametrize("level", ["v2", "V3", "v9", "avx"])
def test_a_processor_that_there_is_not_is_refused(installed, level):
    told = refusal(installed, UICTEST_PROCESSOR=level)
    assert told == f"UICTEST_PROCESSOR={level}: this processor runs {', '.join(processors())}"


def test_code_for_other_records_is_not_called():
    """A process that runs on while a record gets another field would write beyond it."""
    entry = Entry(STEP.function, tuple(map(widened, STEP.arguments)))
    with pytest.raises(library.KernelError, match=r"records of the rig were changed .* start it again"):
        library.native_function(entry)


def widened(argument):
    """Return what describes records with one more field, in tuples, too."""
    if isinstance(argument, tuple):
        return type(argument)(*map(widened, argument))
    if argument is int or argument.layout.names is None:
        return argument
    return at(np.dtype([*argument.layout.descr, ("more", "f8")]), *argument.shape)


C = ("-x", "c", "-O1")


def test_a_file_is_compiled_again_when_it_or_a_header_below_its_folder_has_changed(tmp_path, monkeypatch):
    """Once the headers of FMI were not looked at: FMUs had the functions of before."""
    monkeypatch.setattr(build, "OBJECTS", tmp_path / "objects")
    source, header = tmp_path / "source" / "number.c", tmp_path / "source" / "below" / "number.h"
    header.parent.mkdir(parents=True)
    compiled = []
    for number in ("1", "2", "1"):
        header.write_text(f"#define NUMBER {number}\n", "utf-8")
        source.write_text('#include "below/number.h"\nint number(void) { return NUMBER; }\n', "utf-8")
        compiled.append(build.compile_file(source, build.TARGETS[build.host()], C))
    first, other, again = compiled
    assert first == again != other
    assert first.read_bytes() != other.read_bytes()
