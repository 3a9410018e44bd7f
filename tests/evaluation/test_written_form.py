"""The JSON form of results is that which pydantic makes of the same annotations."""

import json
from collections.abc import Mapping
from functools import cache
from typing import get_args

import pytest
from hypothesis import HealthCheck, Phase, given, settings, strategies as st
from pydantic import ConfigDict, TypeAdapter

from uictest.judging.evaluation import EffectivePart, Firmness, to_json_form
from uictest.judging.evaluation.result import WrittenCaseResult
from uictest.judging.series.document import _WrittenSeries
from uictest.report.run_folder import _Baseline, _Differences, _Subjects

WRITTEN = {
    "a case": WrittenCaseResult,
    "parts": dict[str, EffectivePart],
    "firmness": Firmness,
    "a series": _WrittenSeries,
    "a baseline": _Baseline,
    "differences": _Differences,
    "subjects": _Subjects,
}


# pydantic writes no other mapping than a dict
st.register_type_strategy(
    Mapping, lambda kind: st.dictionaries(*map(st.from_type, get_args(kind)), max_size=3)
)


@cache
def _adapter(kind):
    return TypeAdapter(list[WRITTEN[kind]], config=ConfigDict(extra="forbid"))


@pytest.mark.parametrize("kind", WRITTEN)
@settings(suppress_health_check=list(HealthCheck), max_examples=10, phases=[Phase.generate])
@given(data=st.data())
def test_the_form_is_that_of_pydantic(kind, data):
    value = data.draw(st.from_type(WRITTEN[kind]))
    [expected] = _adapter(kind).dump_python([value], mode="json", by_alias=True, warnings=False)
    assert json.dumps(to_json_form(WRITTEN[kind], value)) == json.dumps(expected)
