"""Usage errors, arguments that cannot be used, empty selections and help: one table for all commands.

What is refused simulates nothing, writes nothing but a message, and shows no trace of the program.
"""

import contextlib
import re
import shlex
from itertools import product
from pathlib import Path

import pytest

import uictest
from uictest import report
from uictest.cli.entry import execute
from uictest.core.recording import parquet_bytes
from uictest.core.recording.formats import writer_of
from uictest.running.campaign import stop as stop_module

from .conftest import STATED, caliper, rolling_train

HEAD = "schema: uictest/scenario/1\ninitial_speed: 5 km/h\n"
FILES = {
    "scenarios/stop.yaml": f"{HEAD}name: stop\ntags: [wet]\n",
    "two.yaml": f"{HEAD}name: two\nmatrix: {{brake.command: [80 %, 90 %]}}\n",
    "repeated.yaml": f"{HEAD}name: stop\nrepeat: 2\n",
    "invalid.yaml": f"{HEAD}name: stop\nbrake: {{command: 200 %}}\n",
    "variants.yaml": f"{HEAD}name: stop\nmatrix: {{controller: [threshold, slip-band]}}\n",
    "train.yaml": f"{HEAD}name: stop\ntrain: [{{controller: {{connect: 'tcp://127.0.0.1:1'}}}}, {{}}]\n",
    "cars.yaml": f"{HEAD}name: stop\ntrain: [{{count: 2}}]\n",
    "library.yaml": f"{HEAD}name: stop\ncontroller: {{library: wsp.so}}\n",
    "wsp.so": "never loaded",
    "missed.yaml": f"{HEAD}name: missed\nexpect: fail\n",
    "study.sweep.yaml": (
        "schema: uictest/scenario/1\nname: study\nextends: scenarios/stop.yaml\n"
        "vary: {matrix: {rail.friction: [0.08, 0.09], brake.command: [80 %, 90 %]}}\n"
    ),
    "repeated.sweep.yaml": (
        "schema: uictest/scenario/1\nname: again\nextends: repeated.yaml\nvary: {matrix: {seed: [0, 1]}}\n"
    ),
    "repeats.sweep.yaml": (
        "schema: uictest/scenario/1\nname: again\nextends: scenarios/stop.yaml\n"
        "vary: {matrix: {repeat: [1, 2], outcome_of_repeats: [all, median]}}\n"
    ),
    "small.series.yaml": (
        "schema: uictest/series/1\nname: small\ntags: [acceptance]\ncriteria: []\n"
        "dry: dry.yaml\nwet: scenarios/stop.yaml\n"
    ),
    "dry.yaml": f"{HEAD}name: dry\n",
    "b/small.series.yaml": "schema: uictest/series/1\nname: small\ndry: dry.yaml\nwet: wet.yaml\n",
    "b/dry.yaml": f"{HEAD}name: dry\n",
    "b/wet.yaml": f"{HEAD}name: wet\n",
    "wett.series.yaml": "schema: uictest/series/1\nname: small\ndry: dry.yaml\nwet: wett.yaml\n",
    "twice.series.yaml": (
        "schema: uictest/series/1\nname: small\nrequirements: [BR-1, BR-1]\n"
        "dry: dry.yaml\nwet: scenarios/stop.yaml\n"
    ),
    "part.yaml": "schema: uictest/controller/1\nextends: threshold\nhold_limit: 3\n",
    "schemaless.yaml": "name: mine\n",
    "lab.yaml": "schema: uictest/channel-map/1\nname: lab\nextends: uictest\nchannels: {}\n",
    "empty.yaml": "schema: uictest/channel-map/1\nname: lab\nchannels: {speed: v}\ncsv:\n",
    "several.py": "class A:\n    def step(self, inputs): ...\nclass B(A):\n    def step(self, inputs): ...\n",
    "wsp.py": "PARAMETERS = {'a': {'default': 1, 'unit': 's'}}\nclass W:\n    def step(self, inputs): ...\n",
    "other.fmu": "",
    "there.fmu": "older",
    "broken.c": "int broken(",
    "absent.c": "int absent(void);\nint is(void) { return absent(); }",
    "nothing.c": "int nothing;",
    "wsp.cpp": "",
    "requirements.txt": "BR-1\nBR 2\n",
    "table.csv": "a,b\n1,2\n",
    "texts.csv": "time [s],speed [m/s]\n0,10\n1,n.a.\n",
    "falling.csv": "time [s],BC [bar],F [kN]\n0,1,1\n0.1,1,1\n0.05,1,1\n",
    "foreign.csv": "t [s];v [km/h]\n0,0;10,5\n1,0;9,5\n",
    "notes.txt": "notes",
    "broken.parquet": "PAR1 and nothing else",
    "mine/scenarios/first-stop.yaml": "mine",
    "mine/my_wsp.py": "mine",
    "others/schema/scenario.schema.json": "{}",
    "kept/rail.schema.json": '{"const": "uictest/rail/1"}',
    "unfinished/manifest.json": '{"schema": "uictest/manifest/2", "kind": "sweep"}',
    "old/results.json": '{"schema": "uictest/result/1"}',
    "oldsweep/results.json": '{"schema": "uictest/sweep-result/1"}',
    "deep/results.json": "[" * 100_000,
    "deep/manifest.json": "[" * 100_000,
    "deepsweep/results.json": "[" * 100_000,
    "file": "",
}
RUN_OR_RECORDING = "compare takes the folders of two runs, or two recordings"
EXPECTED = "expected schema 'uictest/result/2', kind"
OLD = "written by uictest 0.2 or older: run it again"
KINDS = "cannot be exported; accepted: a shared library (.so) or a part that names one, C sources (.c), and"
REFUSED = {
    "": [("fly", "--help"), ("--nonsense", "--help"), ("'run\x1b[2J'", r"run\x1b[2J")],
    "library": [("fly", "--help")],
    "run": [
        ("--no-such-option", "No such option: --no-such-option"),
        ("-k 'a and'", "in 'a and'"),
        ("-m '(wet'", "in '(wet'"),
        ("-n 0", "neither a number of threads from 1 nor 'auto'"),
        ("-n many", "neither a number of threads from 1 nor 'auto'"),
        ("--maxfail 0", "'0' is too small: at least 1\nTry 'uictest run --help'."),
        ("--maxfail x", "'x' is not a whole number"),
        *((f"--seed {seed}", "--seed") for seed in (-1, 2**32)),
        *((f"--keep {count}", "--keep") for count in (0, -1, "all")),
        *((f"--repeat {count}", "--repeat") for count in (0, 1001)),
        *((f"--record-rate {rate}", "--record-rate") for rate in (0, "nan")),
        ("--format jsn", "'--format': 'jsn' is not one of 'text', 'json', 'github'; did you mean 'json'?"),
        ("--record some", "--record"),
        ("--durations -1", "--durations"),
        ("--report pdf", "no format 'pdf'; accepted: csv, html"),
        ("--draw nothing", "no selected case matches 'nothing'"),
        ("--accept", "there is no --baseline to update"),
        ("--tolerance much", "Invalid value for --tolerance: 'much'"),
        ("--set no-equals-sign", "'no-equals-sign' is not a key and a value"),
        ("--set rail.frictoin=0.1", "did you mean 'friction'?"),
        ("--set simulation.time_step=survey", "uictest sweep ... --set simulation.time_step=survey"),
        ("missing.yaml", "missing.yaml:1:1: no such file\n      = did you mean 'missed.yaml'?"),
        ("table.csv", "`uictest evaluate` judges recordings"),
        ("--calibrated-by missed.yaml", "goes with --firm"),
        ("--real-time repeated.yaml", "stop repeats its stop 2 times; run one stop: --repeat 1"),
        ("--real-time train.yaml", "stop[car=1] is car 1 of 2: cycles of a train are not"),
        ("--real-time small.series.yaml", "small is a series"),
        ("--real-time", "stop has the controller 'threshold'; expected one with `connect`"),
        ("--real-time library.yaml", "expected one with `connect`"),
        ("--baseline deep", "deep is no baseline"),
        ("small.series.yaml b/small.series.yaml", "a second series 'small' in b/small.series.yaml and"),
    ],
    "sweep study.sweep.yaml": [
        ("--shard 3/2", "is not a shard"),
        ("--frontier initial_speed", "needs two values or more"),
        ("--frontier rail.friction --tolerance x", "is not a number"),
        ("--map rail.friction,brake", "name two parameters of rail.friction, brake.command"),
        ("--measure braking_distance", "did you mean 'braking_distance_m'?"),
        ("-k '('", "expected a word"),
        ("--set rail.frictoin=1", "did you mean 'friction'?"),
        ("--report pdf", "no format 'pdf'; accepted: csv, html, junit, md, xlsx"),
    ],
    "sweep": [
        ("repeated.sweep.yaml", "list or sample `seed`"),
        *(
            ("repeats.sweep.yaml", f"vary.matrix.{key}: '{key}' cannot vary: a sweep runs one stop per case")
            for key in ("repeat", "outcome_of_repeats")
        ),
    ],
    "check": [
        ("gone", "gone"),
        ("wett.series.yaml", "wett.series.yaml:4:6: wet: no such file: 'wett.yaml'"),
        ("twice.series.yaml", "twice.series.yaml:3:22: requirements.1: 'BR-1' appears twice"),
    ],
    "list": [
        ("--requirement-list requirements.txt", "add --requirements"),
        ("--fail-uncovered", "add --requirements"),
        ("--requirements --requirement-list requirements.txt", "requirements.txt:2:1: 'BR 2' is not the id"),
    ],
    "evaluate": [
        ("missing.csv STATED", "missing.csv"),
        (". STATED", ".: Is a directory"),
        ("foreign.csv STATED", 'set csv: {delimiter: ";", decimal: ","} in a channel map'),
        ("stop.csv STATED --map nothing", "no channel map 'nothing'"),
        ("stop.csv STATED --map missing.yaml", "missing.yaml"),
        ("stop.csv STATED --map empty.yaml", "empty.yaml:4:5: csv: expected a mapping"),
        *((f"stop.csv STATED --trigger {how}", "trigger") for how in ("sometime", "12", "pressure")),
        ("stop.csv STATED --set=rail.condition=icy", "icy"),
        ("stop.csv STATED --set rail.friction=0.1,0.2", "rail.friction"),
        ("stop.csv STATED --keep 0", "--keep"),
        (
            "stop.csv --set rail.condition=dry",
            "--set brake.position=... --set rig.wsp=... --set criteria=...",
        ),
        ("stop.csv --scenario missing.yaml", "missing.yaml"),
        ("stop.csv --scenario two.yaml", "has 2 cases"),
        ("stop.csv --rail=wet", "In place of --rail write: --set rail.condition=NAME"),
        ("small.series.yaml", "small.dry names no recording: list them under `recordings`"),
        ("small.series.yaml --scenario two.yaml", "a series says itself"),
        ("stop.csv --write-map lab.yaml", "lab.yaml: exists"),
        ("stop.csv stop.csv --write-map new.yaml", "name one FILE"),
        ("stop.csv --write-map new.csv", "a channel map is a .yaml file"),
    ],
    "validate": [("small.series.yaml", "no stop names a recording: list them under `recordings`")],
    "fit --scenario two.yaml -k command=80": [
        ("stop.parquet --break 10", "--break"),
        ("stop.parquet --break '20 m' --break '10 m'", "--break"),
        ("stop.parquet --set rail.friction=x", "rail.friction"),
        ("stop.parquet stop.parquet", "unexpected extra argument"),
    ],
    "export": [
        ("stop.parquet --to xlsx", "no format 'xlsx'"),
        ("stop.parquet --to ''", "--to"),
        ("stop.parquet", "--to"),
        ("missing.parquet --to csv", "missing.parquet"),
        ("table.csv --to mat", "no channel 'time' in seconds"),
        ("texts.csv --to mat", "channel 'speed' contains texts, the first in line 3, column 2"),
        ("stop.parquet b/stop.parquet --to csv", "several recordings would be written to stop.csv"),
        ("stop.parquet b/stop.parquet -o stop.mf4", "one file for 2 recordings"),
        ("stop.parquet --to csv", "already there: stop.csv; --force replaces them"),
    ],
    "compare": [
        ("missing.parquet missing.parquet", "missing.parquet: No such file"),
        ("notes.txt notes.txt", "notes.txt: no line of samples"),
        ("broken.parquet broken.parquet", "broken.parquet"),
        ("reports/latest two.yaml", f"two.yaml is a file; {RUN_OR_RECORDING}"),
        ("scenarios stop.parquet", f"scenarios holds no run: it has no results.json; {RUN_OR_RECORDING}"),
        ("scenarios reports/latest", f"scenarios holds no run: it has no results.json; {RUN_OR_RECORDING}"),
        ("unfinished unfinished", f"unfinished holds a sweep; {RUN_OR_RECORDING}"),
        ("reports/latest unfinished", f"unfinished holds a sweep; {RUN_OR_RECORDING}"),
        ("reports/latest nowhere", f"there is no nowhere; {RUN_OR_RECORDING}"),
        ("deep deep", "cannot compare as runs: "),
        ("stop.parquet stop.parquet --tolerance much", "Invalid value for --tolerance: 'much'"),
        ("stop.parquet stop.parquet --channel speed", "there is no --html page to draw on"),
        (
            "stop.parquet stop.parquet --html new.html --channel sped",
            "did you mean 'speed'? both have: speed",
        ),
        ("reports/latest", "give a second run or recording, or --over KEY"),
        ("reports/latest reports/latest --over controller", "leave B out"),
        ("reports/latest --over controller --tolerance 1", "goes with neither --tolerance nor --channel"),
        ("reports/latest --over friction", "--over: "),
        ("reports/latest --over controller --over controller", "--over: "),
        ("scenarios --over controller", "--over takes the folder of a run"),
    ],
    "report": [
        ("missing", "there is no missing; report takes the folder of a finished run or sweep"),
        ("scenarios", "scenarios holds no run: it has no results.json; report takes the folder of a"),
        ("unfinished", "unfinished holds a sweep that is not finished: run its command again"),
        ("reports/latest --format pdf", "no format 'pdf'"),
        ("reports/latest --format html --draw zzz", "no case of the run matches 'zzz'"),
        ("reports/latest --format html --draw 'a and'", "in 'a and'"),
        ("deepsweep", "cannot be read as a run"),
        ("old", f"{EXPECTED} 'run', found schema 'uictest/result/1', {OLD}"),
        ("oldsweep", f"{EXPECTED} 'run', found schema 'uictest/sweep-result/1', {OLD}"),
    ],
    "open": [
        ("zzz", "there is no run 'zzz' in reports"),
        ("scenarios", "scenarios holds no finished run"),
        ("../..", "holds no finished run"),
        ("-o nowhere", "there is no folder nowhere"),
        ("reports/latest", "--format html writes it"),
        ("--rail=wet", "--help"),
    ],
    "bench": [
        ("", "name one recipe"),
        ("stepwize", "stepwise"),
        ("missing.yaml", "missing.yaml"),
        ("stepwise --trace x.csv", "name one recipe"),
        ("--trace x.csv", "x.csv"),
        ("stepwise -o x.txt", "x.txt: write a .parquet or a .csv file"),
        ("stepwise --set rig.caliper.preload=1", "has no unit"),
    ],
    "identify": [
        ("air stop.csv --trust .", "UICTEST_TRUST=DIR"),
        ("hysteresis missing.parquet", "no such file"),
        ("hysteresis record.parquet --force kraft", "no channel 'kraft'"),
        ("hysteresis record.parquet --base seven-inch", "six-inch"),
        ("hysteresis record.parquet --force valve_command_1", "--force and --command both name"),
        ("hysteresis record.parquet --wsp 3", "--wsp '3'"),
        ("hysteresis record.parquet --wsp 0..inf", "--wsp '0..inf'"),
        ("hysteresis record.parquet --acting-time nan", "--acting-time"),
        ("hysteresis record.parquet --transition-time -1", "--transition-time"),
        ("hysteresis falling.csv --pressure BC --force F --wsp 0..1", "0.05 s follows 0.1 s at sample 2"),
        ("cylinder record.parquet --input clamping_force_1", "unit 'kN'"),
        ("cylinder record.parquet --input valve_command_1", "unit '1'"),
        ("cylinder record.parquet --input cylinder_pressure_1", "--input and --output-channel both name"),
        ("cylinder record.parquet -o x.yaml --name 'Our caliper'", "--name"),
        ("cylinder broken.parquet", "broken.parquet"),
    ],
    "export-rig": [
        ("scenarios/stop.yaml -k dry", "--case ID"),
        ("scenarios/stop.yaml --contract 3", "3 is no version, expected 1 or 2"),
        ("scenarios/stop.yaml -o rig.zip", "rig.zip: the name of an FMU ends with .fmu"),
        ("no-such.yaml -o there.fmu", "already there: there.fmu; --force replaces it"),
        ("invalid.yaml", "invalid.yaml:4:18"),
        (
            "two.yaml",
            "2 cases; an FMU holds one: choose it with --case ID\ntwo[command=80]\ntwo[command=90]\n",
        ),
        *(
            (f"cars.yaml {chosen}", "stop[car=1] is car 1 of 2: here a car runs alone")
            for chosen in ("", "--case 'stop[car=1]'")
        ),
    ],
    "export-controller": [
        ("threshold -o there.fmu", "already there: there.fmu; --force replaces it"),
        ("threshold --source wsp.c", "threshold: --source is for a part (.yaml) that names a library"),
        *(
            (name, f"{name}: a controller of kind {kind} {KINDS}")
            for name, kind in (("wsp.py", "python"), ("tcp://127.0.0.1:5", "connect"), ("other.fmu", "fmu"))
        ),
        ("nowhere.c", "nowhere.c: no such C source"),
        ("part.yaml --source wsp.cpp", "wsp.cpp: no such C source; other languages: build a library (.so)"),
        ("broken.c", "broken.c:1:"),
        ("absent.c", "undefined symbol: absent"),
        ("nothing.c", "nothing.so does not export uictest_abi_version"),
    ],
    "controller check": [
        ("no-such.py", "no-such.py"),
        ("several.py", "Those with a method step: 'A', 'B'"),
        ("wsp.py --set a", "'a' is not NAME=VALUE"),
        ("wsp.py --set b=2.5", "no parameter b"),
        ("threshold --set a=1", "for controllers from outside"),
        ("threshold --time-limit 1", "for controllers from outside"),
    ],
    "init": [
        ("mine", "already there: mine/scenarios/first-stop.yaml"),
        ("others", "not written by this version of uictest: others/schema/scenario.schema.json"),
        ("somewhere --c b", "write `uictest init controller` with --python or --c"),
        ("controller", "with either --python DIR or --c DIR"),
        ("controller --python a --c b", "with either --python DIR or --c DIR"),
        ("controller --scenarios", "without the word controller"),
        ("controller --python mine", "already there: mine/my_wsp.py"),
    ],
    "schema": [
        ("rail --all schema", "either KIND or --all DIR"),
        ("--all kept", "not written by this version of uictest: kept/rail.schema.json"),
    ],
    "library show": [
        ("scenarios/stop.yaml", "scenarios/stop.yaml:1:9: schema: not a part"),
        ("part.yaml", "part.yaml:3:13: hold_limit"),
        ("schemaless.yaml", "not a part: its schema is none"),
        ("vehicles/intercity", "did you mean 'vehicles/intercity-180'?"),
        ("vehicle/intercity-180", "vehicles/intercity-180"),
        *((name, "accepted: ") for name in ("zzz", "'\x1b[2J'", "''")),
    ],
    "selftest": [("all", "unexpected extra argument")],
}
NOTHING_SELECTED = {
    "run others": "no scenario in what was given",
    "run -k snow": "nothing selected among 1 case; their tags: wet",
    "run small.series.yaml -k nothing": "0 cases and 1 series; their tags: acceptance",
    "list -m dry": "nothing selected among 1 case; their tags: wet",
    "list study.sweep.yaml -k nothing": "nothing selected",
    "sweep study.sweep.yaml -k nothing": "nothing selected among 4 cases",
    "export-rig two.yaml --case two": "two[command=80]\ntwo[command=90]\n",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A working folder with what commands read."""
    folder = tmp_path_factory.mktemp("usage")
    with contextlib.chdir(folder):
        for name, text in FILES.items():
            Path(name).parent.mkdir(parents=True, exist_ok=True)
            Path(name).write_text(text)
        Path("circle").symlink_to("circle")
        for name in ("stop.parquet", "b/stop.parquet"):
            Path(name).write_bytes(parquet_bytes(rolling_train(0.1)))
        writer_of("csv")(rolling_train(), Path("stop.csv"))
        Path("record.parquet").write_bytes(parquet_bytes(caliper()))
        assert execute(["run", "variants.yaml", "--report", "csv"]) == 0
    return folder


@pytest.fixture
def refused(call, folder, workplace, monkeypatch):
    """Call a command that must come to an exit code without a stop and without changing a file."""

    def simulate(*arguments):
        raise AssertionError("a stop is simulated")

    def run(command, code, said):
        monkeypatch.chdir(folder)
        monkeypatch.setattr(stop_module, "run_stop", simulate)
        before = tree()
        words = shlex.split(command.replace("STATED", " ".join(STATED)))
        answer = call(*words, code=code)
        assert answer.out == ""
        assert " ".join(said.split()) in " ".join(answer.err.split())
        assert not re.search(r"Traceback|internal error|\x1b", answer.err)
        assert tree() == before

    return run


def tree():
    return {path: path.lstat().st_mtime_ns for path in Path().rglob("*") if not path.is_dir()}


@pytest.mark.parametrize(
    ("command", "said"),
    [(f"{name} {arguments}", said) for name, rows in REFUSED.items() for arguments, said in rows],
)
def test_what_cannot_be_used_exits_4_and_says_what_to_write(refused, command, said):
    refused(command, 4, said)


@pytest.mark.parametrize(("command", "said"), NOTHING_SELECTED.items())
def test_where_nothing_is_selected_the_exit_code_is_5(refused, command, said):
    refused(command, 5, said)


READING = {
    "run": "run PATH",
    "run of a series": "run PATH.series.yaml",
    "run, baseline": "run scenarios --baseline PATH",
    "check": "check PATH",
    "list": "list PATH",
    "list, requirements": "list --requirements --requirement-list PATH scenarios",
    "evaluate": "evaluate PATH --scenario scenarios/stop.yaml",
    "evaluate, map": "evaluate stop.parquet --scenario scenarios/stop.yaml --map PATH.yaml",
    "export": "export PATH --to csv",
    "bench": "bench PATH",
    "report": "report PATH",
    "open": "open PATH",
    "open, output": "open -o PATH",
    "compare": "compare PATH stop.parquet",
    "controller check": "controller check PATH",
}
LONG = "n" * 300
PATHS = {
    "too long": LONG,
    "below one too long": f"{LONG}/inner",
    "through a file": "file/inner",
    "through nothing": "/proc/none/inner",
    "in a circle": "circle",
}


@pytest.mark.parametrize("path", PATHS.values(), ids=PATHS)
@pytest.mark.parametrize("command", READING.values(), ids=READING)
def test_a_path_that_cannot_be_is_a_usage_error(refused, command, path):
    refused(command.replace("PATH", path), 4, "")


@pytest.mark.parametrize("path", PATHS.values(), ids=PATHS)
def test_a_folder_of_earlier_runs_that_cannot_be_selects_all_or_is_refused(call, scenario, path):
    scenario("stop")
    Path("file").touch()
    Path("circle").symlink_to("circle")
    answer = call("run", "--lf", "--dry-run", "-o", path)
    assert answer.code in (0, 4)
    assert "internal error" not in answer.err


def test_an_error_of_the_machine_is_none_of_usage(call, scenario, monkeypatch):
    def full(*arguments, **options):
        raise OSError(28, "No space left on device", "reports/x")

    monkeypatch.setattr("uictest.runs.load_cases_and_series", full)
    scenario("stop")
    call("run", "-o", "reports", code=3)


def test_what_is_missing_is_told_with_the_way_to_it(call, monkeypatch):
    call("run", code=4, says="uictest init")
    monkeypatch.setenv("CC", "no-such-compiler")
    Path("wsp.c").write_text("")
    call("export-controller", "wsp.c", code=4, says="uictest: no C compiler (no-such-compiler): pip install")


def test_the_version_and_the_formats_of_a_sweep(call):
    assert call("--version").out == f"uictest {uictest.__version__}\n"
    names = ", ".join(report.FORMATS)
    assert f"joined by commas: {names}. [default" in " ".join(call("sweep", "--help").out.split())


@pytest.mark.parametrize("option", ["-h", "--help"])
def test_help_names_commands_and_exit_codes(call, option):
    answer = call(option, code=0)
    for word in ("run", "check", "list", "schema", "init", "library", "5 nothing selected"):
        assert word in " ".join(answer.out.split())


@pytest.mark.parametrize("group", [[], ["library"], ["identify"], ["controller"]])
def test_without_a_command_the_help_is_shown_and_nothing_was_tested(call, group):
    answer = call(*group)
    assert (answer.code, answer.err) == (4, "")
    assert answer.out == call(*group, "--help").out


@pytest.mark.parametrize(
    ("columns", "group"), [*product(["40", "60", "80", "120"], [[], ["identify"], ["library"]])]
)
def test_the_list_of_commands_holds_whole_sentences(call, monkeypatch, columns, group):
    monkeypatch.setenv("COLUMNS", columns)
    paragraphs = call(*group, "--help").out.split("\n\n")
    sections = [each for each in paragraphs if re.match(r"[A-Z][\w ]+:\n  [a-z]", each)]
    listed = [row for each in sections for row in re.split(r"\n  (?=[a-z])", each.rstrip())[1:]]
    assert listed
    assert [each for each in listed if not each.endswith(".") or each.endswith("...")] == []
