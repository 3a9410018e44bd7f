"""Files that must be refused, each with the place, the key and a hint that helps."""

from collections.abc import Callable
from pathlib import Path

import pytest

from uictest.plans.scenario import Diagnostic

HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 120 km/h\n"
SPEED = "schema: uictest/scenario/1\nname: stop\ninitial_speed: "
NAME = "schema: uictest/scenario/1\ninitial_speed: 120 km/h\nname: "

# what, file, line, column, key, part of the message, part of the hint
Row = tuple[str, str | bytes, int, int, str, str, str]

SHAPE: list[Row] = [
    ("empty file", "", 1, 1, "", "the file is empty", "schema"),
    ("only comments", "# nothing\n", 1, 1, "", "the file is empty", "schema"),
    ("list at top level", "- a\n- b\n", 1, 1, "", "must contain a mapping", "schema"),
    ("scalar at top level", "stop", 1, 1, "", "must contain a mapping", "schema"),
    ("binary garbage", b"name: \xff\xfe\x00", 1, 7, "", "0xff is not UTF-8", "UTF-8"),
    ("UTF-16", "name: x\n".encode("utf-16"), 1, 1, "", "0xff is not UTF-8", "UTF-8"),
    ("control character", HEAD + "title: \x1b[31m\n", 4, 8, "", "'\\x1b' is not allowed", "text file"),
    ("NUL", HEAD + "title: a\x00\n", 4, 9, "", "'\\x00' is not allowed", "text file"),
    ("two documents", HEAD + "---\n" + HEAD, 4, 1, "", "a second YAML document", "one file"),
    ("indented by a tab", HEAD + "rail:\n\tfriction: 0.1\n", 5, 1, "", "not valid YAML", "not with tabs"),
    ("bracket left open", HEAD + "tags: [a\n", 5, 1, "", "not valid YAML", ""),
    ("duplicate key", HEAD + "name: other\n", 4, 1, "name", "duplicate key 'name'", "line 2"),
    ("mapping as a key", HEAD + "? [a]\n: b\n", 4, 3, "", "a key must be a text", "key: value"),
    ("tag", HEAD + "title: !!python/object:os.system x\n", 4, 8, "", "tag ", "without a tag"),
    ("anchor", HEAD + "title: &a x\n", 4, 8, "", "anchor '&a'", "extends"),
    ("nested deeply", "a: " + "[" * 60 + "]" * 60, 1, 24, "", "nested deeper than 20", ""),
    ("too many values", "a: [" + "1," * 25_000 + "]", 1, 39999, "", "more than 20000 values", ""),
    ("too large", b"#" * (256 * 1024 + 1), 1, 1, "", "larger than 256 KiB", "scenario file"),
]

HEADER: list[Row] = [
    ("no schema", "name: stop\n", 1, 1, "schema", "missing key 'schema'", "uictest/scenario/1"),
    ("another schema", HEAD.replace("/1", "/2"), 1, 9, "schema", "found 'uictest/scenario/2'", ""),
    ("a sweep", HEAD.replace("scenario/1", "sweep/1"), 1, 9, "schema", "uictest/sweep/1", "`uictest sweep`"),
    ("schema of a part", HEAD.replace("scenario/1", "vehicle/1"), 1, 9, "schema", "uictest/vehicle/1", ""),
    ("no name", HEAD.replace("name: stop\n", ""), 1, 1, "name", "missing key 'name'", "lower-case"),
    ("name with blanks", NAME + "a b\n", 3, 7, "name", "'a b' is not allowed", "a-z"),
    ("name with markup", NAME + "'[red]<b>x'\n", 3, 7, "name", "'[red]<b>x' is not allowed", "a-z"),
    ("name with an escape", NAME + '"a\\e[2J"\n', 3, 7, "name", "'a\\x1b[2J' is not allowed", "a-z"),
    ("name leaving the tree", NAME + "../../etc/x\n", 3, 7, "name", "'../../etc/x' is not", "a-z"),
    ("name too long", NAME + "a" * 101 + "\n", 3, 7, "name", "is not allowed", "100"),
    ("name is a number", NAME + "12\n", 3, 7, "name", "expected a text, found a number", 'quotes: "12"'),
    ("title of two lines", HEAD + 'title: "a\\nb"\n', 4, 8, "title", "'a\\x0ab' is not", "control"),
    (
        "tags are one text",
        HEAD + "tags: slip\n",
        4,
        7,
        "tags",
        "expected a list, found a text",
        "`tags: [slip]`",
    ),
    ("a tag is a number", HEAD + "tags: [a, 1]\n", 4, 11, "tags.1", "expected a text", "quotes"),
    ("a title that YAML takes for truth", HEAD + "title: true\n", 4, 8, "title", "a text", 'quotes: "true"'),
    ("a list for a title", HEAD + "title: [a]\n", 4, 8, "title", "expected a text, found a list", ""),
]

KEYS: list[Row] = [
    ("unknown key", HEAD + "rial: {}\n", 4, 1, "rial", "unknown key 'rial'", "did you mean 'rail'?"),
    ("unknown inner key", HEAD + "rail: {frction: 1}\n", 4, 8, "rail.frction", "unknown", "'friction'"),
    ("dotted key", HEAD + "rail.friction: 0.1\n", 4, 1, "rail.friction", "unknown key", "matrix"),
    (
        "section is a number",
        HEAD + "brake: 5\n",
        4,
        8,
        "brake",
        "expected a mapping, found a number",
        "command",
    ),
    ("a rail for the section", HEAD + "rail: wet\n", 4, 7, "rail", "a mapping", "`rail: {condition: wet}`"),
    (
        "a friction for the section",
        HEAD + "rail: 0.1\n",
        4,
        7,
        "rail",
        "a mapping",
        "`rail: {friction: 0.1}`",
    ),
    ("a system for the section", HEAD + "brake: ep-disc\n", 4, 8, "brake", "a mapping", "{system: ep-disc}"),
    ("a state for the section", HEAD + "rig: bypassed\n", 4, 6, "rig", "a mapping", "`rig: {wsp: bypassed}`"),
    (
        "points without points",
        HEAD + "rail: {friction: [{position: 0 m, friction: 0.1}]}\n",
        4,
        18,
        "rail.friction",
        "a mapping, found a list",
        "`friction: {points: [{position",
    ),
    (
        "a list for a value",
        HEAD + "rail: {friction: [0.1, 0.2]}\n",
        4,
        18,
        "rail.friction",
        "expected a number",
        "`matrix: {rail.friction: [0.1, 0.2]}`",
    ),
    (
        "a list for a value of a part",
        HEAD + "vehicle: {extends: crh380a, body: {mass: [30 t, 40 t]}}\n",
        4,
        42,
        "vehicle.body.mass",
        "expected a mass",
        "`matrix: {vehicle.body.mass: [30 t, 40 t]}`",
    ),
    (
        "a diameter",
        HEAD + "vehicle: {extends: crh380a, wheelset: {diameter: 920 mm}}\n",
        4,
        40,
        "vehicle.wheelset.diameter",
        "unknown key",
        "`radius: 460 mm`, half the diameter",
    ),
    (
        "a wheelbase",
        HEAD + "vehicle: {extends: crh380a, bogie: {wheelbase: 2.5 m}}\n",
        4,
        37,
        "vehicle.bogie.wheelbase",
        "unknown key",
        "`half_wheelbase: 1.25 m`",
    ),
    (
        "a key of a section at the top",
        HEAD + "friction: 0.1\n",
        4,
        1,
        "friction",
        "unknown",
        "rail.friction?",
    ),
    (
        "half a key's name",
        SPEED.replace("initial_speed", "speed") + "9 m/s\n",
        3,
        1,
        "speed",
        "unknown key",
        "'initial_speed'",
    ),
    ("a truth value for a state", HEAD + "rig: {wsp: false}\n", 4, 12, "rig.wsp", "'false'", "'bypassed'"),
    ("off for none", HEAD + "rig: {compensation: off}\n", 4, 21, "rig.compensation", "'off'", "'none'"),
    (
        "a digit for a word",
        HEAD + "rig: {topology: 4-caliper}\n",
        4,
        17,
        "rig.topology",
        "",
        "'four-caliper'",
    ),
    ("a seed in quotes", HEAD + "seed: '1'\n", 4, 7, "seed", "expected a whole number", "without quotes"),
    ("no initial speed", HEAD[:37], 1, 1, "initial_speed", "missing key 'initial_speed'", "Train speed"),
    ("unknown choice", HEAD + "rig: {wsp: activ}\n", 4, 12, "rig.wsp", "'activ'", "'active'"),
    ("on is a text", HEAD + "rig: {wsp: on}\n", 4, 12, "rig.wsp", "unknown value 'on'", "'active'"),
    ("unknown outcome", HEAD + "expect: passed\n", 4, 9, "expect", "pass, fail, invalid", "'pass'"),
    ("unknown position", HEAD + "brake: {position: Q}\n", 4, 19, "brake.position", "'Q'", "G, P, R"),
    ("position in lower case", HEAD + "brake: {position: r}\n", 4, 19, "brake.position", "'r'", "'R'"),
    ("seed is a share", HEAD + "seed: 1.5\n", 4, 7, "seed", "expected a whole number", ""),
    ("seed is a truth value", HEAD + "seed: true\n", 4, 7, "seed", "expected a whole number", ""),
    ("seed below zero", HEAD + "seed: -1\n", 4, 7, "seed", "at least 0", ""),
]

QUANTITIES: list[Row] = [
    ("no unit", SPEED + "120\n", 3, 16, "initial_speed", "'120' has no unit", "`120 km/h` or `120 m/s`"),
    ("unknown unit", SPEED + "120 kmh\n", 3, 16, "initial_speed", "unknown unit 'kmh'", "'km/h'"),
    ("unit of something else", SPEED + "4 bar\n", 3, 16, "initial_speed", "unit 'bar' for a speed", "m/s"),
    ("decimal comma", SPEED + "'33,3 m/s'\n", 3, 16, "initial_speed", "not a number", "'33.3 m/s'"),
    ("NaN", SPEED + ".nan\n", 3, 16, "initial_speed", "not a finite number", "km/h"),
    ("NaN with a unit", SPEED + "nan km/h\n", 3, 16, "initial_speed", "not a finite number", "km/h"),
    ("infinite", SPEED + "inf km/h\n", 3, 16, "initial_speed", "not a finite number", "km/h"),
    ("huge exponent", SPEED + "1e999 km/h\n", 3, 16, "initial_speed", "not a finite number", ""),
    ("absurd exponent", SPEED + "1e99999 km/h\n", 3, 16, "initial_speed", "unknown unit 'e99999 km/h'", ""),
    ("a word", SPEED + "fast\n", 3, 16, "initial_speed", "'fast' is not a speed", "km/h"),
    ("a list", SPEED + "[120 km/h]\n", 3, 16, "initial_speed", "expected a speed", "km/h"),
    ("a truth value", SPEED + "true\n", 3, 16, "initial_speed", "expected a speed", "km/h"),
    ("too fast", SPEED + "700 km/h\n", 3, 16, "initial_speed", "at most 600 km/h", "above 1 km/h"),
    ("standing", SPEED + "0 km/h\n", 3, 16, "initial_speed", "above 1 km/h", "at most 600 km/h"),
    ("command bare", HEAD + "brake: {command: 90}\n", 4, 18, "brake.command", "no unit", "90 %"),
    (
        "command as a ratio",
        HEAD + "brake: {command: 1.0}\n",
        4,
        18,
        "brake.command",
        "no unit",
        "`100 %` (a b",
    ),
    (
        "mass in kg bare",
        HEAD + "vehicle: {extends: crh380a, body: {mass: 43862}}\n",
        4,
        42,
        "vehicle.body.mass",
        "no unit",
        "write `43862 kg`",
    ),
    ("command over full", HEAD + "brake: {command: 101 %}\n", 4, 18, "brake.command", "100 %", ""),
    ("friction with unit", HEAD + "rail: {friction: 9 %}\n", 4, 18, "rail.friction", "bare number", "0.09"),
    (
        "friction in bar",
        HEAD + "rail: {friction: 9 bar}\n",
        4,
        18,
        "rail.friction",
        "bare number",
        "such as 0.1",
    ),
    ("friction above one", HEAD + "rail: {friction: 1.2}\n", 4, 18, "rail.friction", "at most 1", "0.001"),
    ("gradient too steep", HEAD + "rail: {gradient: 9 %}\n", 4, 18, "rail.gradient", "60 permille", ""),
]

PARTS: list[Row] = [
    ("unknown vehicle", HEAD + "vehicle: intercity\n", 4, 10, "vehicle", "no vehicle", "'intercity-180'"),
    ("unknown condition", HEAD + "rail: {condition: wte}\n", 4, 19, "rail.condition", "no rail", "'wet'"),
    ("unknown criteria", HEAD + "criteria: [uictest-stp]\n", 4, 12, "criteria.0", "no", "'uictest-stop'"),
    ("no criteria", HEAD + "criteria: []\n", 4, 11, "criteria", "empty list", "at least one"),
    ("missing part file", HEAD + "vehicle: car.yaml\n", 4, 10, "vehicle", "no such file", "paths start"),
    ("absolute path", HEAD + "vehicle: /car.yaml\n", 4, 10, "vehicle", "an absolute path", "relative"),
    ("path without suffix", HEAD + "vehicle: cars/ic\n", 4, 10, "vehicle", "no vehicle", "ends in .yaml"),
    ("part is a list", HEAD + "vehicle: [a]\n", 4, 10, "vehicle", "found a list", ""),
    ("part is nothing", HEAD + "vehicle:\n", 4, 9, "vehicle", "found nothing", ""),
    (
        "unknown key of a part",
        HEAD + "vehicle: {extends: intercity-180, body: {mas: 30 t}}\n",
        *(4, 42, "vehicle.body.mas", "unknown key 'mas'", "'mass'"),
    ),
    (
        "key of another algorithm",
        HEAD + "controller: {extends: slip-band, deep_slide: 30 %}\n",
        *(4, 34, "controller.deep_slide", "unknown key 'deep_slide'", "'upper_slide'"),
    ),
    (
        "inline part in part",
        HEAD + "vehicle:\n  body: {mass: 30 t, pitch_inertia: 1e6 kg m2}\n",
        *(5, 3, "vehicle.body.height", "missing key 'height'", "centre of gravity"),
    ),
    (
        "unknown source",
        HEAD + "vehicle: {extends: crh380a, body: {mass: {value: 30 t, source: nobody}}}\n",
        *(4, 64, "vehicle.body.mass.source", "unknown source 'nobody'", "crh380a"),
    ),
    (
        "value without source",
        HEAD + "vehicle: {extends: crh380a, body: {mass: {value: 30 t}}}\n",
        *(4, 42, "vehicle.body.mass", "found a mapping", "'value' and 'source'"),
    ),
    (
        "unknown algorithm",
        HEAD + "controller: {extends: threshold, algorithm: treshold}\n",
        *(4, 45, "controller.algorithm", "unknown algorithm 'treshold'", "'threshold'"),
    ),
    (
        "no algorithm",
        HEAD + "controller: {cycle_time: 10 ms}\n",
        *(4, 13, "controller", "no controller is named", "write `extends: threshold`"),
    ),
    (
        "half a tooth",
        HEAD + "rig: {sensors: {extends: standard, speed: {teeth: 80.5}}}\n",
        *(4, 51, "rig.sensors.speed.teeth", "not a whole number", ""),
    ),
]

IMPOSSIBLE: list[Row] = [
    (
        "a body of 45 kg",
        HEAD + "vehicle: {extends: intercity-180, body: {mass: 45 kg}}\n",
        *(4, 48, "vehicle.body.mass", "at least 1 t", "at least 1 t and at most 200 t"),
    ),
    (
        "a suspension of 1e-9 N/m",
        HEAD + "vehicle: {extends: intercity-180, primary: {vertical_stiffness: 1e-9 N/m}}\n",
        *(4, 65, "vehicle.primary.vertical_stiffness", "at least 1 kN/m", "1000 MN/m"),
    ),
    (
        "springs too soft for their load",
        HEAD + "vehicle: {extends: intercity-180, secondary: {vertical_stiffness: 20 kN/m}}\n",
        *(4, 67, "vehicle.secondary.vertical_stiffness", "32.37 t swing at 0.25 Hz", "1.44 times"),
    ),
    (
        "a brake for another car",
        HEAD + "brake: {system: {extends: ep-disc, disc: {calipers_per_wheelset: 8, pad_friction: 1}}}\n",
        *(4, 8, "brake", "slow this car of 45 t by", "mass of the vehicle"),
    ),
    (
        "dampers that the step cannot follow",
        HEAD + "vehicle: {extends: intercity-180, traction_link: {damping: 1e7 N s/m}}\n",
        *(4, 10, "vehicle", "0.5 ms is too long for the longitudinal motion", "at most 0.259 ms"),
    ),
    (
        "a valve slower than the rig remembers",
        HEAD + "brake: {system: {extends: ep-disc, wsp_valve: {switching_delay: 250 ms}}}\n",
        *(4, 65, "brake.system.wsp_valve.switching_delay", "too long", "25 cycles"),
    ),
    (
        "wheels overlap",
        HEAD + "vehicle: {extends: crh380a, bogie: {half_wheelbase: 0.4 m}}\n",
        *(4, 53, "vehicle.bogie.half_wheelbase", "overlap", ""),
    ),
    (
        "wheelset heavier at the rim than in all",
        HEAD + "vehicle: {extends: crh380a, wheelset: {rotational_inertia: 400 kg m2}}\n",
        *(4, 60, "vehicle.wheelset.rotational_inertia", "no wheelset", "at most"),
    ),
    (
        "compressor cuts in above cut-out",
        HEAD + "brake: {system: {extends: ep-disc, compressor: {cut_in_pressure: 9 bar}}}\n",
        *(4, 66, "brake.system.compressor.cut_in_pressure", "start at 9 bar and stop at 8 bar", "below"),
    ),
    (
        "line pressure above the reservoir",
        HEAD + "brake: {system: {extends: ep-disc, positions: {R: {maximum_pressure: 9 bar}}}}\n",
        *(4, 70, "brake.system.positions.R.maximum_pressure", "cannot reach 9 bar", "initial_pressure"),
    ),
    (
        "balls larger than the tank",
        HEAD + "brake: {system: {extends: ep-disc, caliper_tank: {ball_volume: 3 L}}}\n",
        *(4, 64, "brake.system.caliper_tank.ball_volume", "do not fit", ""),
    ),
    (
        "modelled air that a step overheats",
        HEAD + "rig: {compensation: thermal, compensation_model: {extends: six-inch, air:"
        " {caliper_heat_conductance: 9000 W/K}}}\n",
        *(4, 102, "rig.compensation_model.air.caliper_heat_conductance", "too much", "at most 3.37e+03 W/K"),
    ),
    (
        "modelled piston that sweeps a tank",
        HEAD + "rig: {compensation: thermal, compensation_model: {extends: six-inch, air:"
        " {swept_volume: 3 L}}}\n",
        *(
            4,
            90,
            "rig.compensation_model.air.swept_volume",
            "leaves no air",
            "below brake.system.tank.volume",
        ),
    ),
    (
        "modelled piston that moves back before it moves out",
        HEAD + "rig: {compensation: thermal, compensation_model: {extends: six-inch, air:"
        " {opening_pressure: 2 bar}}}\n",
        *(4, 94, "rig.compensation_model.air.opening_pressure", "move back at 2 bar", "must not exceed"),
    ),
    (
        "pads that go back in temperature",
        HEAD + "brake: {pad: {temperature: {points: [{temperature: 90 degC, factor: 1},"
        " {temperature: 20 degC, factor: 1}]}}}\n",
        *(4, 87, "brake.pad.temperature.points.1.temperature", "20 degC does not come", "must increase"),
    ),
    (
        "a pad without friction",
        HEAD + "brake: {pad: {speed: {points: [{speed: 0 km/h, factor: 0}]}}}\n",
        *(4, 56, "brake.pad.speed.points.0.factor", "at least 0.1", "at least 0.1 and at most 5"),
    ),
    (
        "a pad that brakes against nothing",
        HEAD + "brake: {pad: {force: {numerator: 200 kN, denominator: 0 kN, reference: 15 kN}}}\n",
        *(4, 55, "brake.pad.force.denominator", "at least 0.1 kN", "at least 0.1 kN and at most 1000 kN"),
    ),
    (
        "a pad over a quantity that there is not",
        HEAD + "brake: {pad: {extends: disc-pad, temprature: {points: []}}}\n",
        *(4, 34, "brake.pad.temprature", "unknown key", "temperature"),
    ),
    (
        "no such pad",
        HEAD + "brake: {pad: disc-pads}\n",
        *(4, 14, "brake.pad", "no pad 'disc-pads' in the library", "disc-pad"),
    ),
    (
        "discs hotter than iron",
        HEAD + "brake: {initial_disc_temperature: 1500 degC}\n",
        *(4, 35, "brake.initial_disc_temperature", "at most 1200 degC", "-60 degC"),
    ),
    (
        "discs of which the brake says nothing",
        HEAD + "brake: {disc_temperature: modelled, system: {extends: ep-disc, disc: {thermal: null}}}\n",
        *(
            4,
            27,
            "brake.disc_temperature",
            "brake.system.disc.thermal is missing",
            "disc_temperature: constant",
        ),
    ),
    (
        "kS above kA",
        HEAD + "rail: {condition: {extends: wet, reduction_slip: 0.5}}\n",
        *(4, 50, "rail.condition.reduction_slip", "kS = 0.5 exceeds kA = 0.30", "reduction_adhesion"),
    ),
    (
        "unstable cylinder",
        HEAD + "rig: {compensation_model: {extends: six-inch, cylinder: {denominator: [-3, 3, -1]}}}\n",
        *(4, 71, "rig.compensation_model.cylinder.denominator", "unstable", "unit circle"),
    ),
    (
        "cylinder with gain",
        HEAD + "rig: {compensation_model: {extends: six-inch, cylinder: {numerator: [1, 0, 0, 0]}}}\n",
        *(4, 69, "rig.compensation_model.cylinder.numerator", "the gain at rest is", "must equal"),
    ),
    (
        "squeezing above releasing",
        HEAD + "rig:\n  compensation_model:\n    extends: six-inch\n"
        "    hysteresis: {bc_squeezing: {slope: 5 kN/bar}}\n",
        *(
            7,
            32,
            "rig.compensation_model.hysteresis.bc_squeezing",
            "below the releasing line",
            "bc_releasing",
        ),
    ),
    (
        "friction points out of order",
        HEAD + "rail:\n  friction:\n    points:\n    - {position: 9 m, friction: 0.1}\n"
        "    - {position: 5 m, friction: 0.2}\n",
        *(8, 18, "rail.friction.points.1.position", "5 m does not come after 9 m", "increase"),
    ),
    (
        "friction times not increasing",
        HEAD + "rail: {friction_over_time: {points: [{time: 1 s, factor: 1}, {time: 1 s, factor: 1}]}}\n",
        *(4, 69, "rail.friction_over_time.points.1.time", "does not come after", "increase"),
    ),
    (
        "friction without points",
        HEAD + "rail: {friction: {points: []}}\n",
        *(4, 27, "rail.friction.points", "at least 1", ""),
    ),
    (
        "friction points misspelt",
        HEAD + "rail: {friction: {points: [{position: 0 m, friction: 0.1}], interpolate: steps}}\n",
        *(4, 61, "rail.friction.interpolate", "unknown key 'interpolate'", "'interpolation'"),
    ),
    (
        "step that does not fit the cycle",
        HEAD + "simulation: {time_step: 0.3 ms}\n",
        *(4, 25, "simulation.time_step", "does not divide", "0.5 ms"),
    ),
    (
        "no time to stop",
        HEAD + "simulation: {maximum_duration: 3 s}\n",
        *(4, 32, "simulation.maximum_duration", "cannot end within", "no brake stops"),
    ),
    (
        "downhill on ice",
        HEAD + "rail: {friction: 0.03, gradient: -50 permille}\n",
        *(3, 16, "initial_speed", "cannot end within maximum_duration (180 s)", "never stops"),
    ),
]

SWEEPS: list[Row] = [
    ("empty matrix", HEAD + "matrix: {}\n", 4, 9, "matrix", "an empty mapping", "matrix: {"),
    ("matrix is a list", HEAD + "matrix: [a]\n", 4, 9, "matrix", "found a list", "matrix: {"),
    ("empty axis", HEAD + "matrix: {seed: []}\n", 4, 16, "matrix.seed", "an empty list", ""),
    ("axis is one value", HEAD + "matrix: {seed: 1}\n", 4, 16, "matrix.seed", "a list of values", "[1]"),
    ("unknown axis", HEAD + "matrix: {sed: [1]}\n", 4, 10, "sed", "unknown key 'sed'", "'seed'"),
    ("axis inside a value", HEAD + "matrix: {initial_speed.x: [1]}\n", 4, 10, "initial_speed", "no keys", ""),
    ("axis without a name", HEAD + "matrix: {rail.: [1]}\n", 4, 10, "", "'rail.' is not a key", "dots"),
    ("name as an axis", HEAD + "matrix: {name: [a]}\n", 4, 10, "name", "cannot vary", ""),
    ("a wrong value", HEAD + "matrix: {rail.friction: [0.1, 2]}\n", 4, 31, "rail.friction", "at most 1", ""),
    ("a value twice", HEAD + "matrix: {seed: [1, 1]}\n", 4, 20, "seed", "'1' appears twice", "line 4"),
    (
        "a value twice under a key that is not the last",
        HEAD + "matrix:\n  rail.friction: [0.1, 0.2, 0.1]\n  brake.command: [80 %, 90 %]\n",
        *(5, 29, "rail.friction", "'0.1' appears twice", "line 5"),
    ),
    (
        "a case included twice",
        HEAD + "matrix: {seed: [1, 2]}\ninclude: [{seed: 2}]\n",
        *(5, 18, "", "a second case 'stop[seed=2]'", "line 4"),
    ),
    (
        "unequal zip",
        HEAD + "zip:\n  seed: [1]\n  expect: [pass, fail]\n",
        6,
        3,
        "zip.expect",
        "2 values",
        "long",
    ),
    (
        "zip and matrix",
        HEAD + "matrix: {seed: [1]}\nzip: {seed: [2]}\n",
        5,
        7,
        "zip.seed",
        "matrix as well",
        "",
    ),
    ("include is a mapping", HEAD + "include: {seed: 1}\n", 4, 10, "include", "a list of mappings", "[{"),
    ("include of nothing", HEAD + "include: [{}]\n", 4, 11, "include", "a mapping of dotted keys", "[{"),
    (
        "exclude unknown",
        HEAD + "matrix: {seed: [1, 2]}\nexclude: [{sed: 1}]\n",
        5,
        12,
        "exclude",
        "sed",
        "'seed'",
    ),
    (
        "exclude no case",
        HEAD + "matrix: {seed: [1, 2]}\nexclude: [{seed: 3}]\n",
        5,
        11,
        "exclude",
        "no case",
        "",
    ),
    ("exclude all", HEAD + "matrix: {seed: [1]}\nexclude: [{seed: 1}]\n", 5, 1, "", "no case remains", ""),
    (
        "a million cases",
        HEAD + "matrix:\n" + "".join(f"  a{n}: [{', '.join('0123456789')}]\n" for n in range(6)),
        *(4, 1, "", "1000000 cases", "sweep"),
    ),
]

ROWS = SHAPE + HEADER + KEYS + QUANTITIES + PARTS + IMPOSSIBLE + SWEEPS


@pytest.mark.parametrize("row", ROWS, ids=[row[0] for row in ROWS])
def test_is_refused_at_its_place(row: Row, refused: Callable[..., tuple[Diagnostic, ...]]) -> None:
    _, content, line, column, key, message, hint = row

    diagnostics = refused(content)

    matching = [each for each in diagnostics if (each.line, each.column, each.key) == (line, column, key)]
    assert matching, "\n".join(map(str, diagnostics))
    assert any(message in each.message and hint in each.hint for each in matching), str(matching[0])


@pytest.mark.parametrize("row", ROWS, ids=[row[0] for row in ROWS])
def test_is_shown_without_anything_a_terminal_acts_on(
    row: Row, refused: Callable[..., tuple[Diagnostic, ...]]
) -> None:
    shown = "\n".join(map(str, refused(row[1])))

    assert shown.replace("\n", "").isprintable()
    assert "Traceback" not in shown


def test_there_are_enough_of_them() -> None:
    assert len(ROWS) >= 40


def test_an_alias_bomb_is_refused_without_being_expanded(
    refused: Callable[..., tuple[Diagnostic, ...]],
) -> None:
    bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n" + "".join(
        f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 12)
    )

    diagnostics = refused(bomb)

    assert (diagnostics[0].line, diagnostics[0].column) == (1, 5)
    assert "anchor '&a0' is not accepted" in diagnostics[0].message
    assert len(diagnostics) <= 20


def test_all_errors_of_a_file_are_told_at_once_from_top_to_bottom(
    refused: Callable[..., tuple[Diagnostic, ...]],
) -> None:
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


def test_errors_of_a_matrix_do_not_hide_each_other_nor_those_elsewhere(
    refused: Callable[..., tuple[Diagnostic, ...]],
) -> None:
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


def test_too_many_cases_do_not_hide_wrong_values(refused: Callable[..., tuple[Diagnostic, ...]]) -> None:
    axes = "".join(
        f"  {key}: [{values}]\n"
        for key, values in (
            ("seed", ", ".join(map(str, range(200)))),
            ("rail.friction", ", ".join(f"{0.1 + n / 1000:g}" for n in range(100)) + ", 7"),
        )
    )

    diagnostics = refused(HEAD + "matrix:\n" + axes)

    assert [(each.line, each.key) for each in diagnostics] == [(4, ""), (6, "rail.friction")]


def test_an_error_in_every_value_of_an_axis_is_told_once_per_value(
    refused: Callable[..., tuple[Diagnostic, ...]],
) -> None:
    diagnostics = refused(HEAD + "matrix: {rail.friction: [2, 3], seed: [1, 2, 3]}\n")

    assert [(each.line, each.column) for each in diagnostics] == [(4, 26), (4, 29)]


def test_a_missing_file_is_told_without_a_line_of_it(tmp_path: Path) -> None:
    from uictest.plans.scenario import ScenarioErrors, load

    with pytest.raises(ScenarioErrors) as caught:
        load([tmp_path / "nothing.yaml"])

    assert "no such file" in caught.value.diagnostics[0].message
    assert caught.value.diagnostics[0].file.endswith("nothing.yaml")


def test_errors_of_several_files_are_told_together(write: Callable[..., Path]) -> None:
    from uictest.plans.scenario import ScenarioErrors, load

    write("set/a.yaml", HEAD.replace("120 km/h", "120"))
    write("set/b.yaml", "- list\n")

    with pytest.raises(ScenarioErrors) as caught:
        load([Path("set")])

    assert [each.file for each in caught.value.diagnostics] == ["set/a.yaml", "set/b.yaml"]


def test_a_hint_too_long_for_an_example_names_the_section_alone(
    refused: Callable[..., tuple[Diagnostic, ...]],
) -> None:
    """An example cut off in the middle would be refused as well."""
    (error,) = refused(f"{HEAD}seed: {list(range(40))}\n")
    assert error.hint == "several values go under matrix"


def test_a_hint_shows_a_whole_example_or_none(
    refused: Callable[..., tuple[Diagnostic, ...]],
) -> None:
    """Half of a long value would be wrong."""
    short, long = (HEAD + f"matrix: {{description: {value}}}\n" for value in ("a", "a" * 90))
    assert [each.hint for each in refused(short)] == ["write `[a]`"]
    assert [each.hint for each in refused(long)] == [""]
