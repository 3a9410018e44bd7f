"""What reports say of the cars of a train."""

from uictest.judging.evaluation import CouplerForces, result_document, results_of
from uictest.judging.evaluation.car_in_train import CarInTrain
from uictest.report.case_table import cases_table
from uictest.report.formats.csv import summary_table
from uictest.report.terminal.verdict_table import case_line
from uictest.report.train_wording import TRAIN_COLUMNS, train_facts

from .builders import make_content, make_result

PLACE = CarInTrain("ice", 2, 3, CouplerForces(17342.0, 250.0), CouplerForces(0.0, 12382.0))
FIGURES = ["ice", 3, 17342.0, 250.0, 0.0, 12382.0]


def test_tables_have_the_train_of_a_car_and_the_forces_in_its_couplers():
    car = make_result(train=PLACE)
    table = summary_table([car, make_result(id="alone")])
    coupled, alone = table.rows
    assert [coupled[name] for name in TRAIN_COLUMNS] == FIGURES
    assert not set(TRAIN_COLUMNS) & set(alone)
    assert set(TRAIN_COLUMNS) <= set(table.columns)
    assert "coupler_ahead_pull_n=17342" in case_line(car)


def test_without_trains_no_table_has_their_columns():
    alone = make_result()
    assert not set(TRAIN_COLUMNS) & set(summary_table([alone]).columns)
    assert "train" not in result_document([alone])["cases"][0]
    assert all(column.heading != "train" for column, _ in cases_table(make_content(alone)).texts)


def test_people_read_the_place_and_kilonewtons():
    leading = make_result(train=CarInTrain("ice", 1, 3, None, PLACE.ahead))
    assert dict(train_facts(leading)) == {
        "place": "car 1 of 3 of ice",
        "coupler behind": "largest pull 17.3 kN, push 0.2 kN",
    }
    texts = {column.heading: text for column, text in cases_table(make_content(leading)).texts}
    assert texts["train"] == ["car 1 of 3; coupler behind: pull 17.3 kN, push 0.2 kN"]


def test_a_document_keeps_the_train():
    car = make_result(train=PLACE)
    assert results_of(result_document([car]))[0].train == PLACE
