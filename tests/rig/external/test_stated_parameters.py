"""`uictest_parameters` of a library: asked where its code runs, in a child process."""

import pytest

from uictest.controllers import ControllerError
from uictest.plans.scenario import load
from uictest.rig.assembly import assemble


def stop(folder, controller):
    path = folder / "stop.yaml"
    head = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 40 km/h\n"
    path.write_text(f"{head}controller: {{library: libbad.so, {controller}}}\n", "utf-8")
    return assemble(load([path])[0])


SILENT = "-DSILENT"


@pytest.mark.parametrize(
    ("option", "controller", "message"),
    [
        ("", "parameters: {fualt: none}", "parameters.fualt: no parameter fualt; did you mean fault?"),
        ("", "parameters: {at: 10000}", "parameters.at: 10000 is out of range; accepted: 0 to 9999"),
        ("", "parameters: {fault: 1}", "parameters.fault: expected a text, found a number (1)"),
        ("", "declared_parameters: {ta: {default: 1, unit: s}}", "no parameter ta; accepted: fault, at"),
        (SILENT, "parameters: {at: 1}", "declares no parameters, given: at; write `declared_parameters:"),
        ('-DSTATED="[]"', "parameters: {at: 1}", "its parameters are not of the form"),
        ('-DSTATED="{"', "parameters: {at: 1}", "its parameters are not of the form"),
        ('-DSTATED="{\\"at\\": {\\"range\\": [0]}}"', "parameters: {at: 1}", "are not of the form"),
    ],
)
def test_what_a_library_does_not_state_ends_the_stop(folder, library, workers, option, controller, message):
    library(*filter(None, [option]))
    with pytest.raises(ControllerError) as error:
        workers.run(stop(folder, controller))
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("option", "controller"),
    [
        ("", "parameters: {at: 9999}"),
        ("", "parameters: {fualt: none}, free_parameters: true"),
        (SILENT, "parameters: {any: 1}, free_parameters: true"),
        (SILENT, "declared_parameters: {at: {default: 9999, unit: '1'}}"),
    ],
)
def test_what_it_states_or_the_part_accepts_runs(folder, library, workers, option, controller):
    library(*filter(None, [option]))
    workers.run(stop(folder, controller))
