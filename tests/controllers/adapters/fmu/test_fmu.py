"""Controllers as FMUs: variables of any name and type, FMUs that cannot be run, FMUs that fail."""

import gc
import tempfile
import threading
import zipfile
from pathlib import Path
from typing import Any

import fmpy
import pytest

from uictest.controllers import ControllerError

MakeFmu = Any


VENTS_TWO_AND_FOUR = ([0, 1, 0, 1], [0, 1, 0, 1])
SPEEDS = (20.0, 9.0, 20.0, 9.0)


@pytest.fixture(params=[2, 3], ids=["FMI 2.0", "FMI 3.0"])
def fmi(request):
    return int(request.param)


@pytest.fixture(autouse=True)
def temporary_folder(monkeypatch, tmp_path_factory):
    """Where FMUs are unpacked."""
    folder = tmp_path_factory.mktemp("unpacked")
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def magnets(answer):
    return answer["hold"].tolist(), answer["vent"].tolist()


def refused(open_fmu, path, *arguments, **names):
    """The message without the name of the file."""
    with pytest.raises(ControllerError) as error:
        open_fmu(path, *arguments, **names)
    assert str(error.value).startswith(f"{path.name} ")
    return str(error.value).removeprefix(f"{path.name} ")


def test_a_step_answers_the_inputs_of_the_same_cycle_unless_the_fmu_answers_late(make_fmu, started, fmi):
    path, nothing = make_fmu(fmi), ([0] * 4, [0] * 4)
    for late, answers in ((0, [VENTS_TWO_AND_FOUR, nothing]), (1, [nothing, VENTS_TWO_AND_FOUR])):
        ask = started(path, {"threshold": 10.0, "late": late})
        assert [magnets(ask(*SPEEDS)), magnets(ask(20.0, 20.0, 20.0, 20.0, cycle=1))] == answers


TYPES = [(2, "Real", "Real"), (2, "Real", "Integer"), (2, "Real", "Boolean"), (2, "Real", "Enumeration")]
TYPES += [(3, "Float32", kind) for kind in ("Float32", "Float64", "Int8", "UInt8", "Int16", "UInt16")]
TYPES += [(3, "Float64", kind) for kind in ("Int32", "UInt32", "Int64", "UInt64", "Enumeration", "Boolean")]


@pytest.mark.parametrize(("fmi", "real", "magnet"), TYPES)
def test_magnets_and_speeds_may_have_any_type_that_holds_them(make_fmu, started, fmi, real, magnet):
    ask = started(make_fmu(fmi, make_fmu.variables(fmi, real=real, magnet=magnet)), {"threshold": 10})
    assert magnets(ask(*SPEEDS)) == VENTS_TWO_AND_FOUR


@pytest.mark.parametrize(
    ("speed", "hold", "names"),
    [
        ("axle[%d].speed", "ev%d", {"wheel_speed": "axle[%d].speed", "hold": "ev%d"}),
        ("u", "y", {"wheel_speed": "u", "hold": "y"}),
        ("wheel_speed", "hold", {}),
    ],
)
def test_variables_have_our_names_or_those_of_the_scenario_and_may_be_arrays(
    make_fmu, started, speed, hold, names
):
    listed = make_fmu.variables(3, speed=speed, hold=hold)
    ask = started(make_fmu(3, listed), {"threshold": 10.0}, **names)
    assert magnets(ask(*SPEEDS)) == VENTS_TWO_AND_FOUR


def test_a_tool_may_count_wheelsets_from_0_and_a_diagnosis_with_a_sign_is_its_32_bits(make_fmu, started, fmi):
    """The place of `late` is shown as the diagnosis."""
    listed = make_fmu.variables(fmi)
    for place in range(4):
        listed[f"v{place}"] = listed.pop(f"wheel_speed_{place + 1}")
    ask = started(make_fmu(fmi, listed), {"threshold": 10.0}, wheel_speed="v%d")
    assert magnets(ask(*SPEEDS)) == VENTS_TWO_AND_FOUR
    listed = make_fmu.variables(2, diagnosis=(34, "output", "Integer"))
    assert int(started(make_fmu(2, listed), {"late": -2})(*SPEEDS)["diagnosis"]) == 0xFFFFFFFE


def test_everything_else_that_a_controller_is_given_is_set_where_there_is_a_variable(make_fmu, started, fmi):
    """Each output shows the place of one input: they have the same value reference."""
    real = {2: "Real", 3: "Float64"}[fmi]
    places = {"time": (13, real), "brake_demand": (12, real), "initial_speed": (15, real)}
    shown = {}
    for name, (place, kind) in places.items():
        causality = "parameter" if name == "initial_speed" else "input"
        given = {name: (place, causality, kind), "seen": (place, "output", kind)}
        ask = started(make_fmu(fmi, make_fmu.variables(fmi, **given)), reference_speed="seen")
        shown[name] = float(ask(*SPEEDS, cycle=3)["reference_speed"])
    assert shown == {"time": 0.03, "brake_demand": 0.0, "initial_speed": 20.0}


def test_an_fmu_with_a_reduction_is_of_version_2_of_the_contract(make_fmu, started, fmi):
    """Outputs show the places of inputs: the reduction what each motor gives, the estimate the load."""
    real, whole = {2: "Real", 3: "Float64"}[fmi], {2: "Boolean", 3: "Int8"}[fmi]
    listed = make_fmu.variables(
        fmi,
        axle_load=(45, "input", real),
        seen=(45, "output", real),
        **{f"motor{n}": (40 + n, "input", real) for n in (1, 2, 3, 4)},
        **{f"dynamic_reduction_{n}": (40 + n, "output", real) for n in (1, 2, 3, 4)},
        **{f"sand_request_{n}": (20 + n, "output", whole) for n in (1, 2, 3, 4)},
    )
    names = {"dynamic_brake": "motor%d", "reference_speed": "seen"}
    ask = started(make_fmu(fmi, listed), {"threshold": 10.0}, **names)
    answer = ask(*SPEEDS, dynamic_brake=[0.5, 0.25, 0.0, 1.0], axle_load=9e4)
    assert answer["dynamic_reduction"].tolist() == [0.5, 0.25, 0.0, 1.0]
    assert (answer["reference_speed"], answer["sand_request"].tolist()) == (9e4, [0, 1, 0, 1])
    assert magnets(answer) == VENTS_TWO_AND_FOUR


@pytest.mark.parametrize(
    ("request_of_it", "names", "first", "expected"),
    [
        ("sand_request", [f"sand_request_{n}" for n in (1, 2, 3, 4)], 21, [0, 1, 0, 1]),
        ("track_brake_request", ["track_brake_request"], 22, 1),
    ],
)
def test_an_fmu_that_asks_for_sand_or_track_brake_alone_is_of_version_2(
    make_fmu, open_fmu, started, fmi, request_of_it, names, first, expected
):
    """Outputs show the places of the vents."""
    whole = {2: "Boolean", 3: "Int8"}[fmi]
    added = {name: (first + place, "output", whole) for place, name in enumerate(names)}
    path = make_fmu(fmi, make_fmu.variables(fmi, **added))
    answer = started(path, {"threshold": 10.0})(*SPEEDS)
    assert answer[request_of_it].tolist() == expected
    assert answer["dynamic_reduction"].tolist() == [0.0] * 4
    assert open_fmu(path).contract == 2


def test_what_only_version_2_has_is_not_set_in_an_fmu_of_version_1(make_fmu, open_fmu, ask, fmi):
    real = {2: "Real", 3: "Float64"}[fmi]
    listed = make_fmu.variables(fmi, axle_load=(43, "input", real), seen=(43, "output", real))
    path = make_fmu(fmi, listed)
    instance = open_fmu(path, reference_speed="seen")
    instance.reset()
    assert (instance.contract, ask(instance, *SPEEDS, axle_load=9e4)["reference_speed"]) == (1, 0.0)
    added = "dynamic_reduction or sand_request or track_brake_request"
    message = f"has no output {added}: without one variables.axle_load has no use"
    assert refused(open_fmu, path, axle_load="axle_load") == message


@pytest.mark.parametrize("fault", [0, 9, 10], ids=["none", "error", "fatal"])
def test_reset_returns_to_the_start_values_and_the_parameters(make_fmu, open_fmu, ask, fmi, fault):
    """Also where it cannot be reset: some tools leave the reset out, though both standards ask for it."""
    path = make_fmu(fmi)
    for _ in range(2):
        instance = open_fmu(path, {"threshold": 10.0, "late": 1, "fault": fault})
        for _ in range(2):
            instance.reset()
            assert magnets(ask(instance, *SPEEDS)) == ([0] * 4, [0] * 4)
            assert magnets(ask(instance, *SPEEDS)) == VENTS_TWO_AND_FOUR
        instance.close()
    other = open_fmu(path)  # the same FMU, with the threshold that it starts with
    other.reset()
    ask(other, *SPEEDS)
    assert magnets(ask(other, *SPEEDS)) == ([0] * 4, [0] * 4)
    # As both standards ask; a tool may keep what belongs to an instance under its name.
    assert len({open_fmu(path)._slave._fmu.instanceName for _ in range(3)}) == 3


def test_an_fmu_is_loaded_once_per_thread_and_two_at_once_are_apart(
    make_fmu, open_fmu, ask, fmi, temporary_folder
):
    """Each copy of the library counts its instances; a copy lies in a folder of its own."""
    kind = {2: "Integer", 3: "UInt32"}[fmi]
    path = make_fmu(fmi, make_fmu.variables(fmi, diagnosis=(30, "output", kind)))
    counts = []
    folders = []

    def use(instance):
        instance.reset()
        counts.append(int(ask(instance, *SPEEDS)["diagnosis"]))
        folders.append(len(list(temporary_folder.iterdir())))

    def use_it_again_and_again():
        for _ in range(3):
            instance = open_fmu(path)
            use(instance)
            instance.close()

    use_it_again_and_again()
    thread = threading.Thread(target=use_it_again_and_again)
    thread.start()
    thread.join()
    gc.collect()
    first, second = open_fmu(path), open_fmu(path)
    use(first)
    use(second)
    assert counts == [1] * 8
    assert folders == [1, 1, 1, 2, 2, 2, 2, 2]


FAULTS = {
    "nan": (1, r"hold_3 is nan, expected 0 or 1"),
    "half": (2, r"vent_2 is 0\.5, expected 0 or 1"),
    "error": (3, r"fmi\dDoStep returned error: told to( 7)?"),
    "fatal": (4, r"fmi\dDoStep returned fatal"),
    "diagnosis": (7, r"diagnosis is nan, expected a whole number of 32 bits"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_step_that_fails_says_what_the_fmu_says_and_the_next_stop_goes_on(
    make_fmu, open_fmu, ask, fmi, fault, capfd
):
    real = {2: "Real", 3: "Float64"}[fmi]
    number, message = FAULTS[fault]
    path = make_fmu(fmi, make_fmu.variables(fmi, magnet=real, diagnosis=(30, "output", real)))
    instance = open_fmu(path, {"fault": number, "at": 1, "threshold": 10.0})
    instance.reset()
    assert magnets(ask(instance, *SPEEDS)) == VENTS_TWO_AND_FOUR
    with pytest.raises(ControllerError, match=f"^{message}$"):
        ask(instance, *SPEEDS)
    instance.close()
    other = open_fmu(path, {"threshold": 10.0})
    other.reset()
    for _ in range(3):
        assert magnets(ask(other, *SPEEDS)) == VENTS_TWO_AND_FOUR
    assert capfd.readouterr().out == ""


def test_an_fmu_that_ends_the_simulation_or_does_not_start_says_why(make_fmu, open_fmu, started, fmi):
    """The version is that of the model description."""
    instance = open_fmu(make_fmu(fmi, about='version="2.4.1"'), {"fault": 8})
    assert instance.version == "2.4.1"
    with pytest.raises(ControllerError, match=r"^fmi\dExitInitializationMode returned error: no start( 7)?$"):
        instance.reset()
    assert open_fmu(make_fmu(fmi)).version == ""
    if fmi == 3:
        ask = started(make_fmu(3), {"fault": 5, "at": 0})
        with pytest.raises(ControllerError, match=r"^the FMU asks to end the simulation$"):
            ask(*SPEEDS)


def test_an_fmu_without_the_variables_that_are_needed_is_refused(make_fmu, open_fmu, fmi):
    path = make_fmu(fmi, make_fmu.variables(fmi, speed="axle_speed_%d"))
    assert refused(open_fmu, path) == (
        "has no input wheel_speed_1; its inputs: axle_speed_1, axle_speed_2, axle_speed_3, axle_speed_4;"
        " name it: variables: {wheel_speed: its_name_%d}"
    )
    many = {f"y{number}": (40, "output", "Boolean") for number in range(9)}
    path = make_fmu(fmi, make_fmu.variables(fmi, vent="release_%d", **many))
    message = refused(open_fmu, path)
    assert message.startswith("has no output vent_1; its outputs: hold_1, hold_2, ")
    assert message.endswith(" and 9 more; name it: variables: {vent: its_name_%d}")


NAMES = [
    (
        {"wheel_speed": "v%d"},
        "has no input v1; its inputs: wheel_speed_1, wheel_speed_2, wheel_speed_3, wheel_speed_4",
    ),
    ({"brake_demand": "demand"}, "has no input demand; its inputs: "),
    ({"wheel_sped": "v%d"}, "has no use for variables.wheel_sped; the keys are wheel_speed, speed_valid, "),
    ({"hold": "hold_1"}, "has one value in hold_1, expected 4; write %d for the number of the wheelset"),
    ({"hold": "wheel_speed_%d"}, "has wheel_speed_1 as input of type "),
    (
        {"wheel_speed": "hold_%d"},
        "has hold_1 as output of type Boolean, expected input of type Real or Float64",
    ),
]


@pytest.mark.parametrize(("names", "message"), NAMES)
def test_names_that_do_not_fit_are_refused(make_fmu, open_fmu, fmi, names, message):
    assert refused(open_fmu, make_fmu(fmi), **names).startswith(message)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"treshold": 1.0}, "has no parameter treshold; did you mean threshold?"),
        (
            {"wheel_speed_1": 1.0},
            "has no parameter wheel_speed_1; accepted: fault, at, threshold, late, steps, on",
        ),
        ({"steps": 1.5}, "has parameter steps of type {whole}, found 1.5"),
        ({"steps": 2**40}, "has parameter steps of type {whole}, found 1099511627776"),
        ({"steps": "many"}, "has parameter steps of type {whole}, found 'many'"),
        ({"on": 2}, "has parameter on of type Boolean, found 2"),
        ({"threshold": True}, "has parameter threshold of type {real}, found True"),
        ({"threshold": [1.0, 2.0]}, "has one value in parameter threshold, found 2"),
    ],
)
def test_parameters_that_do_not_fit_are_refused(make_fmu, open_fmu, fmi, parameters, message):
    whole, real = {2: ("Integer", "Real"), 3: ("Int32", "Float64")}[fmi]
    listed = make_fmu.variables(fmi, steps=(40, "parameter", whole), on=(41, "parameter", "Boolean"))
    found = refused(open_fmu, make_fmu(fmi, listed), parameters)
    assert found.startswith(message.format(whole=whole, real=real))


def test_parameters_may_be_texts_truth_values_whole_numbers_and_arrays(make_fmu, started, fmi):
    whole = {2: "Integer", 3: "Int32"}[fmi]
    listed = make_fmu.variables(
        fmi, text=(50, "parameter", "String"), on=(34, "parameter", "Boolean"), steps=(32, "parameter", whole)
    )
    del listed["late"], listed["at"]
    ask = started(make_fmu(fmi, listed), {"text": "ten meters", "on": True, "steps": 5.0})
    ask(*SPEEDS)
    assert magnets(ask(*SPEEDS)) == VENTS_TWO_AND_FOUR


def test_files_that_are_no_fmu_for_here_are_refused(make_fmu, open_fmu, tmp_path, fmi, temporary_folder):
    text, empty = tmp_path / "text.fmu", tmp_path / "empty.fmu"
    text.write_text("no archive")
    with zipfile.ZipFile(empty, "w") as archive:
        archive.writestr("readme.txt", "")
    here = fmpy.platform if fmi == 2 else fmpy.platform_tuple
    expected = {
        text: "is no FMU: it is not a ZIP archive, or a damaged one",
        empty: "is no FMU: it has no modelDescription.xml",
        make_fmu(fmi, kind="ModelExchange"): "is an FMU without co-simulation: export it for co-simulation",
        make_fmu(fmi, platform="win16"): f"is built only for win16, expected {here} with any.so",
        make_fmu(fmi, token="wrong"): "cannot be instantiated",
        make_fmu(
            fmi, token="wrong", about='generationTool="Tool 7"', interface='needsExecutionTool="true"'
        ): ("cannot be instantiated (it needs its tool on this machine: Tool 7)"),
    }
    assert {path: refused(open_fmu, path) for path in expected} == expected
    reading = refused(open_fmu, make_fmu(fmi, version="1.5"))
    assert reading.startswith("has a modelDescription.xml that cannot be read: ")
    assert list(temporary_folder.iterdir()) == []


def test_a_library_that_cannot_be_loaded_is_refused(make_fmu, open_fmu, fmi, temporary_folder, tmp_path):
    before = Path.cwd()
    make_fmu.libraries = {fmi: b"no library"}
    message = refused(open_fmu, make_fmu(fmi))
    assert message.startswith("cannot be loaded: Failed to load shared library ")
    assert str(temporary_folder) not in message
    assert Path.cwd() == before
    assert list(temporary_folder.iterdir()) == []


def test_an_fmu_of_another_step_is_refused(make_fmu, open_fmu):
    experiment = '<DefaultExperiment stepSize="{}"/>'
    message = "makes steps of 0.003 s: cycle_time is 0.01 s, expected a multiple of it"
    assert refused(open_fmu, make_fmu(2, experiment=experiment.format("0.003"))) == message
    assert refused(open_fmu, make_fmu(3, interface='fixedInternalStepSize="0.003"')) == message
    for size in ("0.01", "0.0025"):
        open_fmu(make_fmu(2, experiment=experiment.format(size)))
        open_fmu(make_fmu(3, interface=f'fixedInternalStepSize="{size}"'))
    variable = 'canHandleVariableCommunicationStepSize="true"'
    open_fmu(make_fmu(2, experiment=experiment.format("0.003"), interface=variable))


def test_a_file_that_changes_after_it_was_read_is_not_loaded_and_a_missing_extra_is_named(
    make_fmu, open_fmu, open_program, monkeypatch
):
    path = make_fmu(2)
    with pytest.raises(ControllerError, match=rf"^{path.name} has changed since the scenario was read$"):
        open_program(path, "0" * 64)
    monkeypatch.setattr("uictest.controllers.adapters.fmu.find_spec", lambda name: None)
    message = r"^controllers as FMUs need FMPy: pip install 'uictest\[fmu\]'$"
    with pytest.raises(ControllerError, match=message):
        open_fmu(path)


def test_a_step_size_or_a_value_reference_that_no_fmu_can_have_is_refused(make_fmu, open_fmu, fmi):
    for size in ("0", "-0.01", "nan", "inf", "soon"):
        stated = {"experiment": f'<DefaultExperiment stepSize="{size}"/>'}
        if fmi == 3:
            stated = {"interface": f'fixedInternalStepSize="{size}"'}
        assert "states a step size that is none" in refused(open_fmu, make_fmu(fmi, **stated))
    for reference in (-1, 2**32):
        listed = make_fmu.variables(fmi)
        listed["hold_1"] = (reference, *listed["hold_1"][1:])
        message = f"has value reference {reference} of hold_1, expected a number from 0 to 4294967295"
        assert refused(open_fmu, make_fmu(fmi, listed)) == message


@pytest.mark.parametrize("identifier", ["../../evil", "a/b", "", "1a", "a b", "\u00e4", "any\n"])
def test_a_library_is_loaded_from_the_fmu_alone(make_fmu, open_fmu, fmi, identifier, temporary_folder):
    path = make_fmu(fmi)
    with zipfile.ZipFile(path) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    [library] = [name for name in content if name.startswith("binaries")]
    (temporary_folder / f"evil{fmpy.sharedLibraryExtension}").write_bytes(content[library])
    named = f'modelIdentifier="{identifier}"'.encode()
    content["modelDescription.xml"] = content["modelDescription.xml"].replace(b'modelIdentifier="any"', named)
    with zipfile.ZipFile(path, "w") as archive:
        for name, each in content.items():
            archive.writestr(name, each)
    assert "expected a name of C" in refused(open_fmu, path)
