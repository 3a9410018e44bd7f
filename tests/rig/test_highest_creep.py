"""The largest creep force against a search over Polach's curve, written out again."""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, strategies as st
from scipy.optimize import minimize_scalar

from uictest.core.physics import contact_stiffness, highest_creep_force
from uictest.plans.scenario import RailCondition, load_part
from uictest.rig.rail_assembly import highest_creep_forces, highest_creep_law

STIFFNESS = 0.25 * 8.1e10 * math.pi * 6e-3 * 5e-3 * 4.3
REFERENCE_LOAD = 55e3


def library_rail(name: str) -> RailCondition:
    condition = load_part(f"rails/{name}")
    assert isinstance(condition, RailCondition)
    return condition


def rail(**changes: float) -> RailCondition:
    return library_rail("wet").model_copy(update=changes)


def creep(w: float, v: float, load: float, mu0: float, condition: RailCondition) -> float:
    """Polach (2005), force of one wheel."""
    ratio, decay = float(condition.friction_ratio), float(condition.friction_decay)
    ka, ks = float(condition.reduction_adhesion), float(condition.reduction_slip)
    mu = mu0 * ((1 - ratio) * math.exp(-decay * w) + ratio)
    eps = STIFFNESS * (load / REFERENCE_LOAD) ** (2 / 3) * w / v / (load * mu)
    return 2 * load * mu / math.pi * (ka * eps / (1 + (ka * eps) ** 2) + math.atan(ks * eps))


def searched(v: float, load: float, mu0: float, condition: RailCondition) -> float:
    slips = np.geomspace(1e-4, 200.0, 400)
    best = int(np.argmax([creep(w, v, load, mu0, condition) for w in slips]))
    around = slips[max(best - 1, 0)], slips[min(best + 1, 399)]
    found = minimize_scalar(
        lambda w: -creep(w, v, load, mu0, condition), bounds=around, method="bounded", options={"xatol": 1e-9}
    )
    return float(-found.fun)


def ours(v: float, load: float, mu0: float, condition: RailCondition) -> float:
    samples = (np.array([x]) for x in (v, load, mu0))
    return float(highest_creep_forces(condition, *samples)[0])


@pytest.mark.parametrize("v", [3.0, 10.0, 33.0, 55.0, 90.0])
@pytest.mark.parametrize("mu0", [0.03, 0.09, 0.15, 0.30, 0.55])
@pytest.mark.parametrize("name", ["wet", "dry"])
def test_the_fit_is_the_maximum_of_the_curve(name: str, mu0: float, v: float) -> None:
    condition = library_rail(name)
    for load in (40e3, 55e3, 70e3):
        expected = searched(v, load, mu0, condition)
        assert ours(v, load, mu0, condition) == pytest.approx(expected, rel=1e-3)


@example(1.0, 1.0, 1.0, 1.0, 3.0)
@given(
    st.floats(0.2, 1.0), st.floats(0.01, 1.0), st.floats(0.1, 1.0), st.floats(0.1, 1.0), st.floats(3.0, 90.0)
)
def test_rails_of_other_laws_are_known_to_a_few_per_cent(
    ratio: float, decay: float, adhesion: float, slip: float, v: float
) -> None:
    condition = rail(
        friction_ratio=ratio,
        friction_decay=decay,
        reduction_adhesion=adhesion,
        reduction_slip=slip * adhesion,
    )
    expected = searched(v, 55e3, 0.1, condition)
    # Of deeper falls the test below says what is not reached.
    assume(expected > 0.4 * 0.1 * 55e3)
    assert ours(v, 55e3, 0.1, condition) == pytest.approx(expected, rel=0.03)


@pytest.mark.xfail(reason="two maxima nearly as high: eight terms miss this one by 3.2 % (known errors)")
def test_a_rail_with_two_maxima_is_known_to_a_few_per_cent():
    condition = rail(
        friction_ratio=0.21875,
        friction_decay=0.4375,
        reduction_adhesion=0.125,
        reduction_slip=0.1015625 * 0.125,
    )
    expected = searched(49.0, 55e3, 0.1, condition)
    assert ours(49.0, 55e3, 0.1, condition) == pytest.approx(expected, rel=0.03)


def test_friction_that_does_not_fall_with_slip_is_all_that_there_is() -> None:
    for constant in (rail(friction_ratio=1.0), rail(friction_decay=0.0)):
        assert ours(20.0, 55e3, 0.1, constant) == pytest.approx(5500.0, rel=1e-3)


def test_at_standstill_it_is_the_whole_friction() -> None:
    scale, coefficients = highest_creep_law(library_rail("wet"))
    stiffness = contact_stiffness(STIFFNESS, 1.0)
    assert highest_creep_force(0.0, 55e3, 0.1, stiffness, scale, *coefficients) == pytest.approx(
        5500.0, rel=2e-3
    )


def test_what_is_not_known_has_no_largest_force() -> None:
    samples = np.array([[20.0, 55e3, 0.1], [np.nan, 55e3, 0.1], [20.0, np.nan, 0.1], [20.0, 55e3, np.nan]])
    highest = highest_creep_forces(rail(), *samples.T)
    np.testing.assert_array_equal(np.isnan(highest), [False, True, True, True])
