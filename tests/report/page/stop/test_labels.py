from hypothesis import given, strategies as st

from uictest.report.page.axis import Axis
from uictest.report.page.stop.mark import Label, Mark, labels_of

AXIS = Axis(0.0, 30.0, 52.0, 948.0)


def _mark(at, label):
    return Mark("speed", "instant", label, at, at)


def test_a_label_stands_at_its_mark_next_to_the_title_and_that_of_a_level_line_at_the_end():
    found = labels_of("Speed", [_mark(20.0, "here")], AXIS)
    assert (found.rows, found.labels) == (1, [Label("here", AXIS.at(20.0), 0, "pass")])
    (label,) = labels_of("Force", [Mark("force", "limit", "limit 1 kN", y=1.0)], AXIS).labels
    assert label.text == "┄ limit 1 kN"
    assert label.x > 800


@given(st.lists(st.tuples(st.floats(0.0, 30.0) | st.none(), st.text("abc", max_size=40)), max_size=12))
def test_labels_lie_over_neither_the_title_nor_each_other(marks):
    title = "Deceleration (bold) and adhesion, g"
    found = labels_of(title, [_mark(at, text) for at, text in marks], AXIS)
    taken = [(0, AXIS.start, AXIS.start + 6.0 * len(title))]
    for label in found.labels:
        right = label.x + 6.0 * len(label.text)
        assert AXIS.start <= label.x
        assert right <= AXIS.end
        assert all(row != label.row or right <= left or label.x >= end for row, left, end in taken)
        taken.append((label.row, label.x, right))
    assert found.rows == 1 + max((label.row for label in found.labels), default=0)
    assert len(found.labels) == sum(bool(text) for _, text in marks)
