from pathlib import Path

import pytest

PYTHON = "class Wsp:\n    def step(self, inputs): ...\n"


@pytest.fixture
def template(call):
    """What `uictest init controller --c wsp` writes; its library is not built."""
    call("init", "controller", "--c", "wsp")


def test_the_template_is_exported_from_its_source_and_keeps_the_part(call, template):
    answer = call("export-controller", "wsp/my-wsp.yaml", "--source", "wsp/wsp.c", "-o", "wsp.fmu")
    assert (answer.out, answer.err) == ("wsp.fmu\n", "")
    described = Path("stop.yaml")
    described.write_text(
        "schema: uictest/scenario/1\nname: s\ninitial_speed: 9 km/h\ncontroller: {fmu: wsp.fmu}\n"
    )
    answer = call("list", "stop.yaml", "--set", "controller.parameters.upper_slides=0.2", code=4)
    assert "did you mean upper_slide?" in answer.err
    answer = call("list", "stop.yaml", "--set", "controller.parameters.upper_slide=2", code=4)
    assert "accepted: 0 to 1" in answer.err


def test_a_source_whose_parameters_a_part_declares_says_how_to_name_it(call, template):
    answer = call("export-controller", "wsp/wsp.c", code=4)
    assert answer.err == (
        "uictest: wsp/wsp.c: uictest_create failed: parameter lower_slide is missing\n"
        "where a part declares its parameters: uictest export-controller PART --source wsp/wsp.c\n"
    )
    assert not Path("controller.fmu").exists()


def test_the_library_of_a_part_has_to_be_built(call, template):
    call("export-controller", "wsp/my-wsp.yaml", code=4, says="no such file: 'libwsp.so'")


@pytest.mark.parametrize(
    ("name", "text", "kind"),
    [
        ("wsp.py", PYTHON, "python"),
        ("tcp://127.0.0.1:5025", "", "connect"),
        ("other.fmu", "", "fmu"),
    ],
)
def test_other_kinds_are_refused_with_what_is_accepted(call, name, text, kind):
    if "/" not in name:
        Path(name).write_text(text)
    answer = call("export-controller", name, code=4)
    assert answer.err == (
        f"uictest: {name}: a controller of kind {kind} cannot be exported; accepted: a shared library (.so)"
        " or a part that names one, C sources (.c), and the built-in controllers slip-band, threshold\n"
    )


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("absent.c", None, "absent.c: no such C source"),
        ("wsp.cpp", "", "wsp.cpp: no such C source; other languages: build a library (.so)"),
        ("wsp.c", "int broken(", "wsp.c:1:"),
        ("wsp.c", "int absent(void);\nint is(void) { return absent(); }", "undefined symbol: absent"),
        ("wsp.c", "int nothing;", "wsp.so does not export uictest_abi_version"),
    ],
)
def test_a_source_that_is_no_controller_is_refused(call, name, text, reason):
    if text is not None:
        Path(name).write_text(text)
    controller = (name,) if name.endswith(".c") else ("wsp.yaml", "--source", name)
    call("export-controller", *controller, code=4, says=reason)


def test_a_source_belongs_to_a_part(call):
    answer = call("export-controller", "threshold", "--source", "wsp.c", code=4)
    assert answer.err == "uictest: threshold: --source is for a part (.yaml) that names a library\n"


def test_a_machine_without_a_compiler_is_told_what_to_install(call, template, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    answer = call("export-controller", "wsp/my-wsp.yaml", "--source", "wsp/wsp.c", code=4)
    assert answer.err.startswith("uictest: no C compiler (no-such-compiler): pip install ziglang")


def test_a_file_that_is_there_stays_without_force(call):
    Path("controller.fmu").write_text("older")
    call("export-controller", "slip-band", code=4, says="already there: controller.fmu; --force replaces it")
    call("export-controller", "slip-band", "--force")
    assert Path("controller.fmu").read_bytes().startswith(b"PK")
