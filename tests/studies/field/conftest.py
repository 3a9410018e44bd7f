import pytest

from studies.field.field_rig import FieldRig


@pytest.fixture(scope="session")
def field_rig(stop_runner):
    return FieldRig(stop_runner)
