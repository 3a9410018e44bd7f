"""Cases chosen in the table and laid over each other, in a browser."""

from .chromium import COMPARED, run, step_to, wait


def _choose(browser, *places):
    script = "const boxes = document.querySelectorAll('input.compare'); boxes[arguments[0]].click()"
    for place in places:
        run(browser, script, place)


def test_two_cases_stand_in_one_plot_with_one_time_axis(browser, page):
    browser.get(page.as_uri())
    assert not browser.find_element("id", "compared").is_displayed()
    _choose(browser, 0)
    assert browser.find_element("css selector", ".comparison-bar").text.startswith("1 case chosen")
    _choose(browser, 2)
    assert wait(browser, COMPARED) == 2
    names = run(browser, "return [...document.querySelectorAll('.cases a')].map((each) => each.textContent)")
    assert names == ["slip-120", "dry-120"]
    traces = run(
        browser,
        "return document.querySelector('.compared-plot').plots.flatMap(({lines, plot}) => lines.map((each) =>"
        " [each.label, each.ink, String(each.dash), plot.scales.x.max]))",
    )
    by_case = {name: {tuple(style) for own, *style in traces if own == name} for name in names}
    assert all(len(styles) == 1 for styles in by_case.values())
    (first,), (second,) = by_case.values()
    assert first[0] != second[0]
    assert first[1] != second[1]
    assert first[2] == second[2]


def test_the_cursor_reads_every_case_next_to_its_measures(browser, page):
    browser.get(page.as_uri())
    _choose(browser, 0, 1)
    assert wait(browser, COMPARED) == 2
    slider = browser.find_element("css selector", "#compared input[type=range]")
    step_to(browser, slider, 294)  # 10 s
    rows = run(
        browser,
        "return Object.fromEntries([...document.querySelectorAll('.values tbody tr')].map((row) => "
        "[row.cells[0].textContent, [...row.cells].slice(1).map((cell) => cell.textContent.trim())]))",
    )
    assert rows["slide, %"] == ["40.0", "40.0"]
    assert rows["train, km/h"] == ["84.0", "84.0"]
    assert rows["braking distance"] == ["465.2 m", "465.2 m"]


def test_clearing_hides_the_comparison_and_gives_the_focus_back(browser, page):
    browser.get(page.as_uri())
    _choose(browser, 0, 1)
    assert wait(browser, COMPARED) == 2
    browser.find_element("css selector", "#compared .clear").click()
    assert wait(browser, "return document.querySelector('#compared').hidden")
    assert run(browser, "return document.querySelectorAll('input.compare:checked').length") == 0
    assert run(browser, "return document.activeElement.matches('input.compare')")


def test_no_more_cases_can_be_chosen_than_can_be_told_apart(browser, page):
    browser.get(page.as_uri())
    run(browser, "document.querySelectorAll('tbody .compare').forEach((box) => box.click())")
    assert wait(browser, COMPARED) == 3
