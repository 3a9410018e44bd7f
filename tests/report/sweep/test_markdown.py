from markdown_it import MarkdownIt

from uictest.report.sweep.formats import append_sweep_step_summary, sweep_markdown

from ..builders import make_result

_READER = MarkdownIt("commonmark", {"html": True}).enable("table")


def test_the_summary_shows_every_finding(make_sweep):
    worst = (make_result(id="b[x]", outcome="fail", criteria=(), reason="locked"), make_result())
    text = sweep_markdown(make_sweep(worst))
    assert text.startswith("## uictest sweep: 4 cases: 3 pass, 1 fail; 1 not as expected\n")
    assert [line.removeprefix("### ") for line in text.splitlines() if line.startswith("### ")] == [
        "90 %",
        "Share of cases met, %",
        "Cases most worth looking at",
        "Cases met by value of each parameter",
        "Share of the variance that each parameter explains",
        "Frontier along 90 %",
        "Measures",
        "Notes",
    ]
    assert "| brake.90 % ↓ rail.friction → | 0.10 | 0.12 |" in text
    assert "| 90 % | **0** | 100 |" in text
    assert "| **fail** | `b[x]` | fail | 465.2 | – |  | fail. Expected: pass; locked |" in text  # noqa: RUF001 - a dash on paper
    assert "|  | 90 % | 2 | 1 | 50 | █████░░░░░ |" in text
    assert "| 90 % = 90 % | not met up to 90 %, met from 0.11 | 90 % |" in text


def test_what_a_sweep_does_not_have_has_no_heading_and_many_values_are_referred_to(make_sweep):
    counts = [{"value": str(k), "cases": 1, "met": 1, "outcomes": {}} for k in range(31)]
    nothing = {"maps": [], "missed": [], "sensitivities": [], "measures": [], "notes": []}
    text = sweep_markdown(make_sweep(frontier=None, **nothing, rates={"rail.friction": counts}))
    assert text.count("### ") == 2
    assert "| `rail.friction` | 31 values, see rates.csv |" in text


def test_a_large_map_is_shown_small(make_sweep):
    values, ones = [str(k) for k in range(1000)], [[1] * 1000] * 1000
    axes = {axis: {"parameter": axis, "values": values} for axis in ("rows", "columns")}
    found = {"measure": "met", **axes, "means": ones, "met": [[0] * 1000, *ones[1:]], "cases": ones}
    text = sweep_markdown(make_sweep(maps=[found]))
    assert "→ | 0 … 41 | 42 … 83 |" in text
    assert "| 0 … 41 | **98** |" in text
    assert "Neighbouring values are shown together; map-met.csv has each of them." in text


def test_the_summary_is_appended_where_github_wants_it(make_sweep, tmp_path, monkeypatch):
    place = tmp_path / "summary"
    place.write_bytes(b"x" * 999_000 + b"\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(place))
    append_sweep_step_summary(make_sweep())
    assert b"\n## uictest sweep: 4 cases" in place.read_bytes()
    assert place.stat().st_size <= 2**20
