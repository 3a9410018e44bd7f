"""Files that must be refused, each with the place, the key and a hint that helps."""

from pathlib import Path

import pytest

from uictest.plans.scenario import ScenarioErrors, load

from .conftest import HEAD, refusals

SPEED = "schema: uictest/scenario/1\nname: stop\ninitial_speed: "
NAME = "schema: uictest/scenario/1\ninitial_speed: 120 km/h\nname: "
MARK = "»".encode()

# What a file says, with `»` before the place of the error; the key, part of the message, part of the hint.

# Whole files; the rows below follow HEAD if they do not begin with a schema.
WHOLE = [
    ("»", "", "the file is empty", "schema"),
    ("»# nothing\n", "", "the file is empty", "schema"),
    ("»- a\n- b\n", "", "must contain a mapping", "schema"),
    ("»stop", "", "must contain a mapping", "schema"),
    (b"name: " + MARK + b"\xff\xfe\x00", "", "0xff is not UTF-8", "UTF-8"),
    (MARK + "name: x\n".encode("utf-16"), "", "0xff is not UTF-8", "it is UTF-16"),
    (MARK + b"#" * (256 * 1024 + 1), "", "larger than 256 KiB", "scenario file"),
    ("a: " + "[" * 20 + "»" + "[" * 40 + "]" * 60, "", "nested deeper than 20", ""),
    ("a: [" + "1," * 19_997 + "»1" + ",1" * 5_000 + "]", "", "more than 20000 values", ""),
    ("»name: stop\n", "schema", "missing key 'schema'", "uictest/scenario/1"),
    (HEAD.replace("uictest/scenario/1", "»uictest/scenario/2"), "schema", "found 'uictest/scenario/2'", ""),
    (HEAD.replace("uictest/scenario", "»uictest/sweep"), "schema", "uictest/sweep/1", "`vary`"),
    (HEAD.replace("uictest/scenario", "»uictest/vehicle"), "schema", "uictest/vehicle/1", "a part"),
    ("»schema: uictest/scenario/1\ninitial_speed: 9 m/s\n", "name", "missing key 'name'", "lower-case"),
    ("»schema: uictest/scenario/1\nname: stop\n", "initial_speed", "missing key", "Train speed"),
    (SPEED.replace("initial_", "»") + "9 m/s\n", "speed", "unknown key", "'initial_speed'"),
]

TEXT = [
    ("title: »\x1b[31m", "", "'\\x1b' is not allowed", "text file"),
    ("title: a»\x00", "", "'\\x00' is not allowed", "text file"),
    ("»---\n" + HEAD, "", "a second YAML document", "one file"),
    ("rail:\n»\tfriction: 0.1", "", "not valid YAML", "not with tabs"),
    ("tags: [a\n»", "", "not valid YAML", ""),
    ('vehicle: "C:»\\wsp.yaml"', "", "not valid YAML", "write / in paths"),
    ("rail: {friction: 0.1,»09}", "rail.09", "unknown key '09'", "decimal point"),
    ("vehicle: »cars\\empty.yaml", "vehicle", "no such file", "write / in place"),
    ("extends: »dry-12", "extends", "no such file", "'dry-120'"),
    ("»name: other", "name", "duplicate key 'name'", "line 2"),
    ("? »[a]\n: b", "", "a key must be a text", "key: value"),
    ("title: »!!python/object:os.system x", "", "tag ", "without a tag"),
    ("title: »&a x", "", "anchor '&a'", "extends"),
]

HEADER = [
    (NAME + "»a b", "name", "'a b' is not allowed", "a-z"),
    (NAME + "»'[red]<b>x'", "name", "'[red]<b>x' is not allowed", "a-z"),
    (NAME + '»"a\\e[2J"', "name", "'a\\x1b[2J' is not allowed", "a-z"),
    (NAME + "»../../etc/x", "name", "'../../etc/x' is not", "a-z"),
    (NAME + "»" + "a" * 101, "name", "is not allowed", "100"),
    (NAME + "»12", "name", "expected a text, found a number", 'quotes: "12"'),
    ('title: »"a\\nb"', "title", "'a\\x0ab' is not", "control"),
    ("brake: {command: »[60 %, 100 %]}", "brake.command", "from when on", "[{at: 0 s, value: 60 %}, ...]"),
    ("tags: »slip", "tags", "expected a list, found a text", "`tags: [slip]`"),
    ("tags: [a, »1]", "tags.1", "expected a text", "quotes"),
    ("title: »true", "title", "a text", 'quotes: "true"'),
    ("title: »[a]", "title", "expected a text, found a list", ""),
]

KEYS = [
    ("»rial: {}", "rial", "unknown key 'rial'", "did you mean 'rail'?"),
    ("rail: {»frction: 1}", "rail.frction", "unknown", "'friction'"),
    ("»rail.friction: 0.1", "rail.friction", "unknown key", "matrix"),
    ("brake: »5", "brake", "expected a mapping, found a number", "command"),
    ("rail: »wet", "rail", "a mapping", "`rail: {condition: wet}`"),
    ("rail: »0.1", "rail", "a mapping", "`rail: {friction: 0.1}`"),
    ("brake: »ep-disc", "brake", "a mapping", "{system: ep-disc}"),
    ("rig: »bypassed", "rig", "a mapping", "`rig: {wsp: bypassed}`"),
    ("»friction: 0.1", "friction", "unknown", "rail.friction?"),
    ("rig: {wsp: »false}", "rig.wsp", "'false'", "'bypassed'"),
    ("rig: {compensation: »off}", "rig.compensation", "'off'", "'none'"),
    ("rig: {topology: »4-caliper}", "rig.topology", "", "'four-caliper'"),
    ("seed: »'1'", "seed", "expected a whole number", "without quotes"),
    ("rig: {wsp: »activ}", "rig.wsp", "'activ'", "'active'"),
    ("rig: {wsp: »on}", "rig.wsp", "unknown value 'on'", "'active'"),
    ("expect: »passed", "expect", "pass, fail, invalid", "`{fail: [locked-wheels]}`"),
    ("brake: {position: »Q}", "brake.position", "'Q'", "G, P, R"),
    ("brake: {position: »r}", "brake.position", "'r'", "'R'"),
    ("seed: »1.5", "seed", "expected a whole number", ""),
    ("seed: »true", "seed", "expected a whole number", ""),
    ("seed: »-1", "seed", "at least 0", ""),
    *refusals("""\
rail: {friction: »[{position: 0 m, friction: 0.1}]}
-> rail.friction | a mapping, found a list | `friction: {points: [{position
rail: {friction: »[0.1, 0.2]}
-> rail.friction | expected a number | `matrix: {rail.friction: [0.1, 0.2]}`
vehicle: {extends: crh380a, body: {mass: »[30 t, 40 t]}}
-> vehicle.body.mass | expected a mass | `matrix: {vehicle.body.mass: [30 t, 40 t]}`
vehicle: {extends: crh380a, wheelset: {»diameter: 920 mm}}
-> vehicle.wheelset.diameter | unknown key | `radius: 460 mm`, half the diameter
vehicle: {extends: crh380a, bogie: {»wheelbase: 2.5 m}}
-> vehicle.bogie.wheelbase | unknown key | `half_wheelbase: 1.25 m`
"""),
]

QUANTITIES = [
    (SPEED + "»120", "initial_speed", "'120' has no unit", "`120 km/h` or `120 m/s`"),
    (SPEED + "»120 kmh", "initial_speed", "unknown unit 'kmh'", "'km/h'"),
    (SPEED + "»4 bar", "initial_speed", "unit 'bar' for a speed", "m/s"),
    (SPEED + "»'33,3 m/s'", "initial_speed", "not a number", "'33.3 m/s'"),
    (SPEED + "».nan", "initial_speed", "not a finite number", "km/h"),
    (SPEED + "»nan km/h", "initial_speed", "not a finite number", "km/h"),
    (SPEED + "»inf km/h", "initial_speed", "not a finite number", "km/h"),
    (SPEED + "»1e999 km/h", "initial_speed", "not a finite number", ""),
    (SPEED + "»1e99999 km/h", "initial_speed", "unknown unit 'e99999 km/h'", ""),
    (SPEED + "»fast", "initial_speed", "'fast' is not a speed", "km/h"),
    (SPEED + "»[120 km/h]", "initial_speed", "expected a speed", "km/h"),
    (SPEED + "»true", "initial_speed", "expected a speed", "km/h"),
    (SPEED + "»700 km/h", "initial_speed", "at most 600 km/h", "above 1 km/h"),
    (SPEED + "»0 km/h", "initial_speed", "above 1 km/h", "at most 600 km/h"),
    ("brake: {command: »90}", "brake.command", "no unit", "90 %"),
    ("brake: {command: »1.0}", "brake.command", "no unit", "`100 %` (a b"),
    ("vehicle: {extends: crh380a, body: {mass: »43862}}", "vehicle.body.mass", "no unit", "write `43862 kg`"),
    ("brake: {command: »101 %}", "brake.command", "100 %", ""),
    ("rail: {friction: »9 %}", "rail.friction", "bare number", "0.09"),
    ("rail: {friction: »9 bar}", "rail.friction", "bare number", "such as 0.1"),
    ("rail: {friction: »1.2}", "rail.friction", "at most 1", "0.001"),
    ("rail: {gradient: »9 %}", "rail.gradient", "60 permille", ""),
]

PARTS = [
    ("vehicle: »intercity", "vehicle", "no vehicle", "'intercity-180'"),
    ("rail: {condition: »wte}", "rail.condition", "no rail", "'wet'"),
    ("criteria: [»uictest-stp]", "criteria.0", "no", "'uictest-stop'"),
    ("criteria: »[]", "criteria", "empty list", "at least one"),
    ("vehicle: »car.yaml", "vehicle", "no such file", "paths start"),
    ("vehicle: »/car.yaml", "vehicle", "an absolute path", "relative"),
    ("vehicle: »cars/ic", "vehicle", "no vehicle", "ends in .yaml"),
    ("vehicle: »[a]", "vehicle", "found a list", ""),
    ("vehicle:»", "vehicle", "found nothing", ""),
    *refusals("""\
vehicle: {extends: intercity-180, body: {»mas: 30 t}}
-> vehicle.body.mas | unknown key 'mas' | 'mass'
controller: {extends: slip-band, »deep_slide: 30 %}
-> controller.deep_slide | unknown key 'deep_slide' | 'upper_slide'
vehicle:
  »body: {mass: 30 t, pitch_inertia: 1e6 kg m2}
-> vehicle.body.height | missing key 'height' | centre of gravity
vehicle: {extends: crh380a, body: {mass: {value: 30 t, source: »nobody}}}
-> vehicle.body.mass.source | unknown source 'nobody' | crh380a
rail: {condition: wet, gradient: {value: 0 permille, source: »survey}}
-> rail.gradient.source | unknown source 'survey' | leave it out
vehicle: {extends: crh380a, body: {mass: »{value: 30 t}}}
-> vehicle.body.mass | found a mapping | 'value' and 'source'
controller: {extends: threshold, algorithm: »treshold}
-> controller.algorithm | unknown algorithm 'treshold' | 'threshold'
controller: »{cycle_time: 10 ms}
-> controller | no controller is named | write `extends: threshold`
rig: {sensors: {extends: standard, speed: {teeth: »80.5}}}
-> rig.sensors.speed.teeth | not a whole number |
"""),
]

IMPOSSIBLE = [
    ("brake: {pad: »disc-pads}", "brake.pad", "no pad 'disc-pads' in the library", "disc-pad"),
    ("rail: {friction: {points: »[]}}", "rail.friction.points", "at least 1", ""),
    ("simulation: {time_step: »0.3 ms}", "simulation.time_step", "does not divide", "0.5 ms"),
    *refusals("""\
vehicle: {extends: intercity-180, body: {mass: »45 kg}}
-> vehicle.body.mass | at least 1 t | at least 1 t and at most 200 t
vehicle: {extends: intercity-180, primary: {vertical_stiffness: »1e-9 N/m}}
-> vehicle.primary.vertical_stiffness | at least 1 kN/m | 1000 MN/m
vehicle: {extends: intercity-180, secondary: {vertical_stiffness: »20 kN/m}}
-> vehicle.secondary.vertical_stiffness | 32.37 t swing at 0.25 Hz | 1.44 times
brake: »{system: {extends: ep-disc, disc: {calipers_per_wheelset: 8, pad_friction: 1}}}
-> brake | slow this car of 45 t by | mass of the vehicle
vehicle: »{extends: intercity-180, traction_link: {damping: 1e7 N s/m}}
-> vehicle | 0.5 ms is too long for the longitudinal motion | at most 0.259 ms
brake: {system: {extends: ep-disc, wsp_valve: {switching_delay: »250 ms}}}
-> brake.system.wsp_valve.switching_delay | too long | 25 cycles
vehicle: {extends: crh380a, bogie: {half_wheelbase: »0.4 m}}
-> vehicle.bogie.half_wheelbase | overlap |
vehicle: {extends: crh380a, wheelset: {rotational_inertia: »400 kg m2}}
-> vehicle.wheelset.rotational_inertia | no wheelset | at most
brake: {system: {extends: ep-disc, compressor: {cut_in_pressure: »9 bar}}}
-> brake.system.compressor.cut_in_pressure | start at 9 bar and stop at 8 bar | below
brake: {system: {extends: ep-disc, positions: {R: {maximum_pressure: »9 bar}}}}
-> brake.system.positions.R.maximum_pressure | cannot reach 9 bar | initial_pressure
brake: {system: {extends: ep-disc, caliper_tank: {ball_volume: »3 L}}}
-> brake.system.caliper_tank.ball_volume | do not fit |
rig: {compensation_model: {extends: six-inch, air: {caliper_heat_conductance: »9000 W/K}}}
-> rig.compensation_model.air.caliper_heat_conductance | too much | at most 3.37e+03 W/K
rig: {compensation_model: {extends: six-inch, air: {swept_volume: »3 L}}}
-> rig.compensation_model.air.swept_volume | leaves no air | below brake.system.tank.volume
rig: {compensation_model: {extends: six-inch, air: {opening_pressure: »2 bar}}}
-> rig.compensation_model.air.opening_pressure | move back at 2 bar | must not exceed
brake: {pad: {temperature: {points: [{temperature: 900 K, factor: 1}, {temperature: »800 K, factor: 1}]}}}
-> brake.pad.temperature.points.1.temperature | 800 K does not come after 900 K | must increase
brake: {pad: {speed: {points: [{speed: 0 km/h, factor: »0}]}}}
-> brake.pad.speed.points.0.factor | at least 0.1 | at least 0.1 and at most 5
brake: {pad: {force: {numerator: 200 kN, denominator: »0 kN, reference: 15 kN}}}
-> brake.pad.force.denominator | at least 0.1 kN | at least 0.1 kN and at most 1000 kN
brake: {pad: {extends: disc-pad, »temprature: {points: []}}}
-> brake.pad.temprature | unknown key | temperature
brake: {initial_disc_temperature: »1500 degC}
-> brake.initial_disc_temperature | at most 1200 degC | -60 degC
brake: {disc_temperature: »modelled, system: {extends: ep-disc, disc: {thermal: null}}}
-> brake.disc_temperature | brake.system.disc.thermal is missing | disc_temperature: constant
rail: {condition: {extends: wet, reduction_slip: »0.5}}
-> rail.condition.reduction_slip | kS = 0.5 exceeds kA = 0.30 | reduction_adhesion
rig: {compensation_model: {extends: six-inch, cylinder: {denominator: »[-3, 3, -1]}}}
-> rig.compensation_model.cylinder.denominator | unstable | unit circle
rig: {compensation_model: {extends: six-inch, cylinder: {numerator: »[1, 0, 0, 0]}}}
-> rig.compensation_model.cylinder.numerator | the gain at rest is | must equal
rig: {compensation_model: {extends: six-inch, hysteresis: {bc_squeezing: »{slope: 5 kN/bar}}}}
-> rig.compensation_model.hysteresis.bc_squeezing | below the releasing line | bc_releasing
rail: {friction: {points: [{position: 9 m, friction: 0.1}, {position: »5 m, friction: 0.2}]}}
-> rail.friction.points.1.position | 5 m does not come after 9 m | increase
rail: {friction_over_time: {points: [{time: 1 s, factor: 1}, {time: »1 s, factor: 1}]}}
-> rail.friction_over_time.points.1.time | does not come after | increase
rail: {friction: {points: [{position: 0 m, friction: 0.1}], »interpolate: steps}}
-> rail.friction.interpolate | unknown key 'interpolate' | 'interpolation'
simulation: {maximum_duration: »3 s}
-> simulation.maximum_duration | cannot end within | no brake stops
"""),
    (
        SPEED + "»120 km/h\nrail: {friction: 0.03, gradient: -50 permille}",
        *("initial_speed", "cannot end within maximum_duration (180 s)", "never stops"),
    ),
]

MATRIX = [
    ("matrix: »{}", "matrix", "an empty mapping", "matrix: {"),
    ("matrix: »[a]", "matrix", "found a list", "matrix: {"),
    ("matrix: {seed: »[]}", "matrix.seed", "an empty list", ""),
    ("matrix: {seed: »1}", "matrix.seed", "a list of values", "[1]"),
    ("matrix: {»sed: [1]}", "sed", "unknown key 'sed'", "'seed'"),
    ("matrix: {»initial_speed.x: [1]}", "initial_speed", "no keys", ""),
    ("matrix: {»rail.: [1]}", "", "'rail.' is not a key", "dots"),
    ("matrix: {»name: [a]}", "name", "cannot vary", ""),
    ("matrix: {rail.friction: [0.1, »2]}", "rail.friction", "at most 1", ""),
    ("matrix: {seed: [1, »1]}", "seed", "'1' appears twice", "line 4"),
    ("matrix: {seed: [1, 2]}\ninclude: [{seed: »2}]", "", "a second case 'stop[seed=2]'", "line 4"),
    ("zip:\n  seed: [1]\n  »expect: [pass, fail]", "zip.expect", "2 values", "long"),
    ("matrix: {seed: [1]}\nzip: {»seed: [2]}", "zip.seed", "matrix as well", ""),
    ("include: »{seed: 1}", "include", "a list of mappings", "[{"),
    ("include: [»{}]", "include", "a mapping of dotted keys", "[{"),
    ("matrix: {seed: [1, 2]}\nexclude: [{»sed: 1}]", "exclude", "sed", "'seed'"),
    ("matrix: {seed: [1, 2]}\nexclude: [»{seed: 3}]", "exclude", "no case", ""),
    ("matrix: {seed: [1]}\n»exclude: [{seed: 1}]", "", "no case remains", ""),
    (
        "matrix:\n  rail.friction: [0.1, 0.2, »0.1]\n  seed: [0, 1]",
        "rail.friction",
        "'0.1' appears",
        "line 5",
    ),
    (
        HEAD.replace("stop", "s" * 60) + f"matrix: {{title: [»{'t' * 150}]}}\n",
        *("name", "longer than 200 characters", ""),
    ),
    ("»matrix:\n" + "".join(f"  a{n}: {[*range(10)]}\n" for n in range(6)), "", "1000000 cases", "sweep"),
]

LAST = 2**32 - 1
"""The largest seed."""
REPEATS = [
    ("repeat: »0", "repeat", "0 is out of range: it must be at least 1", ""),
    ("repeat: »1001", "repeat", "1001 is out of range: it must be at most 1000", ""),
    ("repeat: »2.5", "repeat", "expected a whole number, found a number ('2.5')", ""),
    (
        *(f"seed: {LAST - 5}\nrepeat: »10", "repeat"),
        f"10 stops from seed {LAST - 5} end with seed {LAST + 4}; the largest is {LAST}",
        f"take a seed of at most {LAST - 9}",
    ),
    *refusals("""\
outcome_of_repeats: »90 %
-> outcome_of_repeats | unknown value '90 %', expected one of all, median | write {at_least: 90 %} for
outcome_of_repeats: {at_least: »0.9}
-> outcome_of_repeats.at_least | '0.9' has no unit | write `90 %` (a bare 0.9 is ambiguous)
outcome_of_repeats: {at_least: »0 %}
-> outcome_of_repeats.at_least | 0 % is out of range: it must be above 0 % | accepted: above 0 % and
"""),
]

ADDED = [*TEXT, *HEADER, *KEYS, *QUANTITIES, *PARTS, *IMPOSSIBLE, *REPEATS, *MATRIX]
ROWS = [*WHOLE, *((each[0] if each[0].startswith("schema") else HEAD + each[0], *each[1:]) for each in ADDED)]


@pytest.mark.parametrize(
    ("marked", "key", "message", "hint"), ROWS, ids=[f"{row[1]}: {row[2]}" for row in ROWS]
)
def test_is_refused_at_its_place(marked, key, message, hint, refused):
    before, after = (marked if isinstance(marked, bytes) else marked.encode()).split(MARK)
    line, column = before.count(b"\n") + 1, len(before.rpartition(b"\n")[2]) + 1
    diagnostics = refused(before + after)
    matching = [each for each in diagnostics if (each.line, each.column, each.key) == (line, column, key)]
    shown = "\n".join(map(str, diagnostics))
    assert any(message in each.message and hint in each.hint for each in matching), shown
    assert shown.replace("\n", "").isprintable()
    assert "Traceback" not in shown


def test_an_alias_bomb_is_refused_without_being_expanded(refused):
    bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n" + "".join(
        f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 12)
    )
    diagnostics = refused(bomb)
    assert (diagnostics[0].line, diagnostics[0].column) == (1, 5)
    assert "anchor '&a0' is not accepted" in diagnostics[0].message
    assert len(diagnostics) <= 20


def test_all_errors_of_a_file_are_told_at_once_from_top_to_bottom(refused):
    diagnostics = refused(
        "schema: uictest/scenario/1\n"
        "name: Stop\n"
        "initial_speed: 120\n"
        "brke: {}\n"
        "rail: {friction: 7, gradient: 5}\n"
        "vehicle: nope\n"
        "title: once\n"
        "title: twice\n"
        "matrix: {seed: []}\n"
    )
    assert [(each.line, each.key) for each in diagnostics] == [
        (2, "name"),
        (3, "initial_speed"),
        (4, "brke"),
        (5, "rail.friction"),
        (5, "rail.gradient"),
        (6, "vehicle"),
        (8, "title"),
        (9, "matrix.seed"),
    ]


def test_errors_of_a_matrix_do_not_hide_each_other_nor_those_elsewhere(refused):
    diagnostics = refused(
        HEAD + "brakes: {}\n"
        "matrix:\n"
        "  rail.friction: 0.09\n"
        "  brake.comand: [50 %]\n"
        "  initial_speed.x: [1]\n"
        "  rail.gradient: [5 permille, 90 permille]\n"
        "zip:\n"
        "  seed: [1, 2]\n"
        "  expect: [pas]\n"
        "exclude: [{sed: 1}]\n"
    )
    assert [(each.line, each.key) for each in diagnostics] == [
        (4, "brakes"),
        (6, "matrix.rail.friction"),
        (7, "brake.comand"),
        (8, "initial_speed"),
        (9, "rail.gradient"),
        (12, "zip.expect"),
        (12, "expect"),
        (13, "exclude"),
    ]


def test_every_wrong_value_of_an_axis_is_told_once_also_where_there_are_too_many_cases(refused):
    diagnostics = refused(HEAD + "matrix: {rail.friction: [2, 3], seed: [1, 2, 3]}\n")
    assert [(each.line, each.column) for each in diagnostics] == [(4, 26), (4, 29)]
    axes = "".join(
        f"  {key}: [{values}]\n"
        for key, values in (
            ("seed", ", ".join(map(str, range(200)))),
            ("rail.friction", ", ".join(f"{0.1 + n / 1000:g}" for n in range(100)) + ", 7"),
        )
    )
    diagnostics = refused(HEAD + "matrix:\n" + axes)
    assert [(each.line, each.key) for each in diagnostics] == [(4, ""), (6, "rail.friction")]


def test_a_missing_file_and_the_errors_of_several_are_told_together(tmp_path, write):
    with pytest.raises(ScenarioErrors) as caught:
        load([tmp_path / "nothing.yaml"])
    assert "no such file" in caught.value.diagnostics[0].message
    assert caught.value.diagnostics[0].file.endswith("nothing.yaml")
    write("set/a.yaml", HEAD.replace("120 km/h", "120"))
    write("set/b.yaml", "- list\n")
    with pytest.raises(ScenarioErrors) as caught:
        load([Path("set")])
    assert [each.file for each in caught.value.diagnostics] == ["set/a.yaml", "set/b.yaml"]


def test_a_hint_shows_a_whole_example_or_none(refused, head):
    # Half of a long value would be refused as well.
    rows = ("description: a", "write `[a]`"), (f"description: {'a' * 90}", "")
    for axis, hint in rows:
        assert [each.hint for each in refused(f"{HEAD}matrix: {{{axis}}}\n")] == [hint]
    (error,) = refused(f"{HEAD}seed: {list(range(40))}\n")
    assert error.hint == "several values go under matrix"
    (error,) = refused(f"{head}seed: {'9' * 40}\n")
    assert (error.key, error.hint) == ("seed", "")
