"""The main commands need nothing that Windows lacks, and give what they give elsewhere."""

import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from uictest.cli.output import ExitCode

TESTS = Path(__file__).parent
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="Linux plays the system without POSIX")

STOP = """schema: uictest/scenario/1
name: stop
initial_speed: 40 km/h
rail: {condition: dry}
criteria: [uictest-stop]
"""
SWEEP = """schema: uictest/scenario/1
name: study
extends: stop.yaml
vary: {ranges: {initial_speed: {first: 20 km/h, last: 30 km/h, count: 6}}}
"""
STATES = ("rail.condition=dry", "brake.position=R", "rig.wsp=active", "criteria=uictest-stop")
STATED = [f"--set={state}" for state in STATES]
COMMANDS = [
    ["check", "."],
    ["run", "stop.yaml", "-o", "runs", "--record=all", "--report=csv,html,junit,md,xlsx"],
    ["run", "stop.yaml", "-o", "runs", "--record=all", "--keep=1"],
    ["sweep", "study.sweep.yaml", "-o", "sweeps", "--shard=1/2"],
    ["sweep", "study.sweep.yaml", "-o", "sweeps"],
    ["export", "RECORDING", "--to=csv,mdf", "-o", "."],
    ["evaluate", "stop.csv", "-o", "of-csv", *STATED],
    ["evaluate", "stop.mf4", "-o", "of-mdf", *STATED],
    ["log", "stop.csv", "-o", "logs", *STATED],
    ["fit", "stop.csv", "--scenario=stop.yaml", "-o", "fits"],
    ["compare", "RECORDING", "stop.csv", "--html=compared.html"],
]
COMPARED = {".csv", ".parquet", ".svg", ".yaml"}
"""What is written the same every time."""
DRIVER = """
import json, sys
from pathlib import Path
from uictest.cli.entry import execute
from uictest.core.files import latest_run
codes = []
for command in json.load(sys.stdin):
    recording = f"{latest_run(Path('runs'))}/recordings/stop.parquet"
    codes.append(int(execute([recording if each == "RECORDING" else each for each in command])))
print("codes", codes)
"""
RESTRICTED = f"import sys; sys.path.append({str(TESTS)!r}); import without_posix; without_posix.restrict()\n"


def run(place, *arguments, **options):
    command = [sys.executable, *arguments]
    return subprocess.run(command, cwd=place, capture_output=True, text=True, check=False, **options)


def done_in(place, preparation):
    """Run the commands in a folder of their own; return what they print."""
    place.mkdir()
    for name, text in {"stop": STOP, "study.sweep": SWEEP}.items():
        (place / f"{name}.yaml").write_text(text, "utf-8")
    done = run(place, "-P", "-c", preparation + DRIVER, input=json.dumps(COMMANDS))
    assert done.returncode == 0, done.stderr
    return re.sub(r"took [\d.]+ s|\d{8}T\d{6}Z-[0-9a-f]{8}", "", done.stdout)


def contents(folder):
    """Return what lies below a folder by name, without the times that names and files state."""
    found = {}
    for path in folder.rglob("*"):
        name = re.sub(r"\d{8}T\d{6}Z-[0-9a-f]{8}", "RUN", path.relative_to(folder).as_posix())
        if path.name == "results.json":
            found[name] = json.loads(path.read_bytes()) | {"manifest": None}
        elif path.is_file():
            found[name] = path.read_bytes() if path.suffix in COMPARED else None
    return {name: content for name, content in found.items() if not name.endswith("/latest")}


def test_without_posix_the_main_commands_give_the_same(tmp_path):
    pytest.importorskip("asammdf")
    places, preparations = (tmp_path / "ordinary", tmp_path / "restricted"), ("", RESTRICTED)
    with ThreadPoolExecutor(2) as threads:
        ordinary, restricted = threads.map(done_in, places, preparations)
    assert restricted == ordinary
    assert ordinary.endswith("codes [0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0]\n")  # the stop does not slide: no fit
    assert contents(tmp_path / "restricted") == contents(tmp_path / "ordinary")
    assert len(list(tmp_path.rglob("results.json"))) == 10
    assert list(tmp_path.rglob(".*")) == []
    latest = tmp_path / "restricted" / "runs" / "latest"
    assert not latest.is_symlink()
    assert (latest.with_name(latest.read_text("utf-8").strip()) / "index.html").is_file()


PROGRAM = str(TESTS / "without_posix.py")


def test_a_controller_from_outside_is_refused_in_one_sentence(tmp_path):
    (tmp_path / "wsp.py").write_text("class Wsp: pass")
    (tmp_path / "stop.yaml").write_text(STOP + "controller: {python: wsp.py, class: Wsp}\n")
    done = run(tmp_path, "-P", PROGRAM, "uictest", "run", "stop.yaml")
    assert done.returncode == ExitCode.ERROR
    said = " ".join(done.stdout.split())
    assert said.count("needs Linux: on Windows install and run uictest in the Windows Subsystem") == 1
    assert "Traceback" not in done.stdout + done.stderr


REFUSED = {
    "import fcntl": "ModuleNotFoundError",
    "import os; os.fork()": "AttributeError",
    "import os; os.open('a', os.O_RDONLY, dir_fd=0)": "NotImplementedError",
    "import os; os.symlink('a', 'b')": "OSError",
    "from pathlib import Path; Path('a:b').touch()": "OSError",
    "from pathlib import Path; file = Path('a').open('w'); Path('a').unlink()": "PermissionError",
    "from pathlib import Path; Path('d').mkdir(); file = Path('d/a').open('w'); Path('d').rename('e')": (
        "PermissionError"
    ),
    "import subprocess, sys; subprocess.Popen([sys.executable, '-m', 'this'], pass_fds=[0])": "ValueError",
}


@pytest.mark.parametrize("code", REFUSED)
def test_what_windows_lacks_is_taken_away(tmp_path, code):
    """Else the test above would prove nothing."""
    package = tmp_path / "uictest"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "tried.py").write_text(code)
    done = run(tmp_path, PROGRAM, "uictest.tried", env={"PYTHONPATH": str(tmp_path)})
    assert done.stderr.splitlines()[-1].startswith(REFUSED[code])
