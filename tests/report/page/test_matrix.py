from itertools import product

from uictest.judging.evaluation import EffectivePart, Parameter
from uictest.report.page.overview import maps_of

from ..builders import make_result


def _cases(**keys):
    swept = [dict(zip(keys, values, strict=True)) for values in product(*keys.values())]
    return [
        make_result(id=str(parameters), parameters=parameters, parts={"scenario": _part(parameters)})
        for parameters in swept
    ]


def _part(texts):
    parameters = tuple(
        Parameter(key, float(text.split()[0]) if text[0].isdigit() else text, "", text, "user")
        for key, text in texts.items()
    )
    return EffectivePart("scenario", "", "", None, parameters)


def test_two_swept_keys_make_a_map_in_the_order_of_their_numbers():
    results = _cases(friction=["0.12", "0.09"], command=["100 %", "80 %"], speed=["80 km/h"])
    (found,) = maps_of(results)
    assert (found.row_key, found.column_key) == ("friction", "command")
    assert (found.rows, found.columns) == (["0.09", "0.12"], ["80 %", "100 %"])
    assert found.cells[0][1] is results[2]


def test_texts_that_are_no_numbers_keep_their_order_and_what_was_excluded_leaves_its_cell_empty():
    results = _cases(state=["bypassed", "active"], friction=["0.12", "0.09"])[1:]  # one was excluded
    (found,) = maps_of(results)
    assert (found.rows, found.columns) == (["bypassed", "active"], ["0.09", "0.12"])
    assert found.cells[0][1] is None


def test_one_key_three_keys_and_repeated_cases_make_none():
    assert maps_of(_cases(a=["1", "2"])) == []
    assert maps_of(_cases(a=["1", "2"], b=["1", "2"], c=["1", "2"])) == []
    twice = _cases(a=["1", "2"], b=["1", "2"])
    assert maps_of([*twice, *twice]) == []
