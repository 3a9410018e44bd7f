"""The play operator between two lines."""

from itertools import pairwise

from hypothesis import given, strategies as st

from uictest.core.physics.caliper import force_after, line, phase_share

SQUEEZING = (0.042, -1874.0)
RELEASING = (0.047, -1580.0)
pressure = st.floats(0.0, 5e5)
histories = st.lists(pressure, min_size=1, max_size=30)


def played(history, force=0.0):
    for p in history:
        force = force_after(force, line(p, *SQUEEZING), line(p, *RELEASING))
    return force


@given(histories)
def test_force_lies_between_the_lines(history):
    assert line(history[-1], *SQUEEZING) <= played(history) <= line(history[-1], *RELEASING)


@given(pressure)
def test_force_is_never_negative(p):
    assert line(p, *SQUEEZING) >= 0.0


@given(st.lists(pressure, min_size=2, max_size=15), st.integers(1, 7))
def test_force_depends_on_the_path_and_not_on_its_pace(history, parts):
    """Rate independence: the same turning points, reached in more steps, leave the same force."""
    slow = history[:1]
    for a, b in pairwise(history):
        slow += [a + (b - a) * k / parts for k in range(1, parts)] + [b]
    assert played(slow) == played(history)


@given(st.lists(pressure, max_size=10), pressure, pressure)
def test_inner_loop_returns_to_where_it_began(history, turn, inner):
    """Return-point memory: a closed excursion, repeated, closes on itself."""
    once = played([*history, turn, inner, turn])
    assert played([turn, inner, turn] * 3, once) == played([turn, inner, turn], once)


@given(histories, st.floats(-100.0, 100.0))
def test_force_stays_where_it_is_while_the_pressure_turns(history, turn):
    force = played(history)
    p = max(history[-1] + turn, 0.0)
    if line(p, *SQUEEZING) < force < line(p, *RELEASING):
        assert played([p], force) == force


def test_rising_pressure_follows_the_squeezing_line_falling_the_releasing_one_and_crossed_ones_give_one():
    assert played([0.0, 3e5]) == line(3e5, *SQUEEZING)
    assert played([0.0, 4e5, 3e5]) == line(3e5, *RELEASING)
    # Below their crossing identified lines are in the wrong order; the squeezing line then holds alone.
    assert force_after(0.0, squeezing=50.0, releasing=40.0) == 50.0
    assert force_after(90.0, squeezing=50.0, releasing=40.0) == 50.0


@given(st.floats(0.0, 1.0), st.sampled_from([0.0, 1.0]), st.floats(1e-4, 1.0))
def test_phase_changes_no_faster_than_allowed_and_arrives(share, acting, step):
    after = phase_share(share, acting, step)
    assert abs(after - share) <= step * (1.0 + 1e-12)
    assert abs(after - acting) <= max(abs(share - acting) - step, 0.0) + 1e-12
