import pytest

from uictest.plans.scenario import ScenarioErrors
from uictest.recorded.field_data import stated_case


def test_what_is_stated_becomes_a_case():
    case = stated_case("run", 20.0, ["rail.condition=wet", "brake.position=P", "criteria=uictest-stop"])
    assert case.scenario.rail.condition.name == "wet"
    assert case.scenario.brake.position == "P"
    assert case.scenario.initial_speed == 20.0
    assert any("rails/wet" in name for name in case.inputs)


@pytest.mark.parametrize("statement", ["rail.condition=we", "brake.position=X", "nothing", "seed=1,2"])
def test_what_is_not_acceptable_is_refused(statement):
    with pytest.raises(ScenarioErrors):
        stated_case("run", 20.0, [statement])
