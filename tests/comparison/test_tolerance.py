import pytest

from uictest.analysis.comparison import Tolerance, Tolerances


@pytest.mark.parametrize(
    ("texts", "quantity", "expected"),
    [
        ([], "anything", Tolerance(1e-6, 1e-3)),
        (["1 %"], "anything", Tolerance(1e-6, 0.01)),
        (["1e-3"], "anything", Tolerance(1e-3, 0.0)),
        (["0.5", "1%", "0.2"], "anything", Tolerance(0.2, 0.01)),
        (["slide_*=0.02", "1%"], "slide_3", Tolerance(0.02, 0.0)),
        (["slide_*=0.02", "slide_3=5%"], "slide_3", Tolerance(1e-6, 0.05)),
        (["slide_*=0.02", "slide_3=5%", "slide_*=1%"], "slide_3", Tolerance(0.02, 0.01)),
        (["slide_*=0.02", "slide_3=5%"], "slide_4", Tolerance(0.02, 0.0)),
    ],
)
def test_the_last_pattern_that_fits_counts(texts, quantity, expected):
    assert Tolerances.read(texts).of(quantity) == expected


@pytest.mark.parametrize("text", ["", "x", "-1", "1 m", "a=", "a=b", "nan", "inf", "1..2", "=1", "1e999"])
def test_what_is_no_tolerance_is_named(text):
    with pytest.raises(ValueError, match="is not a tolerance"):
        Tolerances.read([text])


def test_the_larger_allowance_counts():
    assert Tolerance(0.5, 0.01).allowed(10.0) == 0.5
    assert Tolerance(0.5, 0.01).allowed(100.0) == 1.0
    assert Tolerance(0.5, 0.01).allowed(float("nan")) == 0.5
