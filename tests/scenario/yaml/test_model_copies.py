"""A copy of a model knows nothing that was worked out of the values before."""

import copy
from functools import cached_property

import pytest

from uictest.plans.scenario.yaml import Model


class Counted(Model):
    number: int

    @cached_property
    def doubled(self):
        return [2 * self.number]


@pytest.mark.parametrize("deep", [False, True])
def test_a_cached_property_of_a_copy_is_that_of_its_own_values(deep):
    original = Counted(number=1)
    assert original.doubled == [2]
    assert original.model_copy(update={"number": 3}, deep=deep).doubled == [6]
    assert original.doubled == [2]


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, Counted.model_copy])
def test_a_copy_is_equal_whether_or_not_something_was_worked_out(copied):
    original = Counted(number=1)
    assert original.doubled == [2]
    assert copied(original) == original == Counted(number=1)
    assert copied(original).doubled == [2]
