"""The parts that ship: every number with its source, published numbers as published."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
import yaml

from uictest.plans import library
from uictest.plans.scenario import ScenarioErrors, load, load_part, numbers
from uictest.rig import simulate

REFERENCES = [f"{folder}/{name}" for folder in library.FOLDERS for name in library.names(folder)]


def value(reference, key):
    return {number.key: float(number.quantity) for number in numbers(load_part(reference))}[key]


def mark(reference, key):
    source = {number.key: number.source for number in numbers(load_part(reference))}[key]
    assert source is not None
    return source.mark


@pytest.mark.parametrize("reference", REFERENCES)
def test_a_part_says_what_it_is_and_every_number_and_source_is_used_and_explained(reference):
    part = load_part(reference)

    assert part.name == reference.split("/")[1]
    assert part.title
    assert [number.key for number in numbers(load_part(reference)) if number.source is None] == []
    part = load_part(reference)
    used = {number.quantity.source for number in numbers(part)}
    used |= {end.source for number in numbers(part) for end in number.quantity.range or ()}
    for criterion in getattr(part, "criteria", ()):
        used |= {criterion.source, *(reading.source for reading in criterion.readings)}
        used |= {criterion.reading_source} if criterion.readings else set()

    assert used == set(part.sources)
    assert all(len(source.text) > 20 for source in part.sources.values())
    part = load_part(reference)
    for number in numbers(part):
        if number.quantity.range is not None:
            text = part.sources[number.quantity.range[0].source].text.lower()
            named = set(re.findall(r"(?<![-\w])(?:log-)?uniform\b", text))
            assert number.quantity.prior in named, (number.key, text)


def test_the_parts_named_in_the_documents_are_there():
    named = """
        brakes/ep-disc calipers/six-inch compensations/six-inch controllers/threshold
        criteria/uic-541-05-appendix-b criteria/uictest-stop pads/composite-block pads/constant pads/disc-pad
        rails/dry rails/wet sensors/standard
        vehicles/crh380a vehicles/intercity-180 vehicles/manchester-benchmark
    """
    assert set(named.split()) <= set(REFERENCES)


NUMBERS = [
    ("published", "vehicles/manchester-benchmark", "body.mass", 32_000.0),
    ("published", "vehicles/manchester-benchmark", "body.pitch_inertia", 1.97e6),
    ("published", "vehicles/manchester-benchmark", "primary.longitudinal_stiffness", 31.391e6),
    ("published", "vehicles/manchester-benchmark", "secondary.vertical_stiffness", 430e3),
    ("published", "rails/dry", "friction", 0.55),
    ("published", "rails/dry", "friction_decay", 0.60),
    ("published", "rails/wet", "friction", 0.30),
    ("published", "rails/wet", "reduction_adhesion", 0.30),
    ("published", "rails/wet", "reduction_slip", 0.10),
    ("published", "brakes/ep-disc", "disc.pad_friction", 0.38),
    ("published", "brakes/ep-disc", "disc.thermal.conductivity", 46.0),
    ("published", "brakes/ep-disc", "disc.thermal.density", 7500.0),
    ("published", "brakes/ep-disc", "disc.thermal.specific_heat", 490.0),
    ("published", "brakes/ep-disc", "air.atmospheric_pressure", 101_325.0),
    ("stated", "brakes/ep-disc", "reservoir.volume", 0.3),
    ("stated", "brakes/ep-disc", "reservoir.initial_pressure", 8e5),
    ("stated", "brakes/ep-disc", "tank.volume", 2e-3),
    ("stated", "brakes/ep-disc", "caliper_tank.ball_volume", 0.21e-3),
    ("stated", "calipers/six-inch", "piston_area", 0.01824),
    ("stated", "compensations/six-inch", "sampling_time", 0.5e-3),
    ("chosen", "vehicles/crh380a", "body.mass", 43_862.5),
    ("chosen", "vehicles/crh380a", "secondary.vertical_damping", 40e3),
    ("chosen", "rails/wet", "contact.kalker_coefficient", 4.3),
    ("chosen", "brakes/ep-disc", "disc.mean_radius", 0.289),
    ("chosen", "calipers/six-inch", "spring_rate", 1645.0),
    ("chosen", "rails/wet-cleaning", "cleaning.energy", 5300.0),
    ("chosen", "rails/wet-cleaning", "cleaning.recovered_friction", 0.28),
    ("chosen", "rails/wet-cleaning", "cleaning.reach", 0.5),
    ("chosen", "rails/wet-cleaning", "cleaning.carry_over", 0.5),
]
"""Chosen are those, too, whose publication nobody can name."""


@pytest.mark.parametrize(("stated", "reference", "key", "number"), NUMBERS)
def test_numbers_are_those_of_their_sources(stated, reference, key, number):
    assert value(reference, key) == pytest.approx(number, rel=1e-12)
    assert mark(reference, key) == stated


def test_every_stated_or_published_source_names_a_publication_and_a_place():
    folder = Path(library.__file__).parent
    texts = [
        (path.name, key, source["text"])
        for path in folder.glob("*/*.yaml")
        for key, source in yaml.safe_load(path.read_text("utf-8")).get("sources", {}).items()
        if source["mark"] in ("stated", "published")
    ]
    assert {text.partition(": ")[0] for *_, text in texts} == set(library.references())
    assert [(file, key) for file, key, text in texts if len(text.partition(": ")[2]) < 10] == []


def test_numbers_follow_from_what_the_sources_state():
    # 0.053 L over the area of the piston; the paper states no stroke.
    stroke = 0.053e-3 / value("calipers/six-inch", "piston_area")
    assert value("calipers/six-inch", "clearance") == pytest.approx(stroke, rel=5e-3)
    assert mark("calipers/six-inch", "clearance") == "chosen"
    assert value("brakes/ep-disc", "caliper_tank.ball_volume") == pytest.approx(
        367 * 3.141592653589793 / 6 * 0.0103**3, rel=2e-3
    )
    car = load_part("vehicles/intercity-180")

    assert car.total_mass == pytest.approx(45_000.0)
    assert {source.mark for source in car.sources.values()} == {"chosen"}
    # 740 mm outer and 425 mm inner diameter; the pads act near the middle of the ring.
    assert value("brakes/ep-disc", "disc.thermal.area") == pytest.approx(
        math.pi / 4.0 * (0.740**2 - 0.425**2), rel=1e-3
    )
    assert 0.425 / 2.0 < value("brakes/ep-disc", "disc.mean_radius") < 0.740 / 2.0
    for name in ("brakes/ep-disc", "brakes/distributor"):
        [pads] = [each for each in numbers(load_part(name)) if each.key == "disc.pad_friction"]
        assert [float(end) for end in pads.quantity.range] == [0.35, 0.45]
    # k2 200 kN, k3 50 kN, k4 150 km/h, k5 75 km/h: nobody has checked them against the publication.
    numbers_of_law = [
        ("force.numerator", 200e3),
        ("force.denominator", 50e3),
        ("speed.numerator", 150.0 / 3.6),
        ("speed.denominator", 75.0 / 3.6),
    ]
    for key, recalled in numbers_of_law:
        assert value("pads/composite-block", key) == pytest.approx(recalled)
        assert mark("pads/composite-block", key) == "chosen"
    for name in library.names("controllers"):
        marks = {source.mark for source in load_part(f"controllers/{name}").sources.values()}
        assert marks == {"chosen"}


WITHOUT_RANGE = {
    *("calipers_per_wheelset", "pads_per_caliper", "teeth", "missing_teeth"),  # they can be counted
    *("range", "reference", "eccentricity"),  # of an instrument or a curve; a momentary reading has none
    *("speed", "force", "temperature", "factor"),  # a point of a curve, which would bend if it moved alone
}
"""Last words of the keys of chosen numbers that state no plausible range."""


@pytest.mark.parametrize(
    "reference",
    [
        each
        for each in REFERENCES
        if each.startswith(("vehicles/", "brakes/", "calipers/", "pads/", "rails/", "sensors/"))
    ],
)
def test_every_chosen_number_of_the_rig_states_a_plausible_range(reference):
    chosen = [each for each in numbers(load_part(reference)) if each.source.mark == "chosen"]
    without = [each.key for each in chosen if each.quantity.range is None]
    assert [key for key in without if key.rpartition(".")[2] not in WITHOUT_RANGE] == []


def test_an_unknown_part_is_refused_with_the_nearest():
    with pytest.raises(ScenarioErrors, match="did you mean 'intercity-180'"):
        load_part("vehicles/intercity-108")
    with pytest.raises(KeyError):
        load_part("cars/intercity-180")


@pytest.mark.parametrize(
    ("folder", "name"), [("vehicles", "../rails/dry"), ("..", "x"), ("vehicles", "nothing")]
)
def test_only_what_is_listed_can_be_read(folder, name):
    with pytest.raises(KeyError):
        library.content(folder, name)


SCENARIO = Path(__file__).parents[2] / "scenarios" / "slip-120.yaml"
RATE = 100
LIMIT = 0.35


def test_the_largest_slide_passes_where_the_largest_mean_over_a_second_does_not():
    (case,) = load([SCENARIO])
    recording = simulate(case, record_every=1.0 / RATE).recording
    assert recording is not None
    fast = recording["speed"] > 30.0 / 3.6
    slides = [1.0 - recording[f"wheel_speed_{n}"][fast] / recording["speed"][fast] for n in (1, 2, 3, 4)]
    means = [np.convolve(slide, np.full(RATE, 1.0 / RATE), "valid") for slide in slides]
    assert all(slide.max() > LIMIT for slide in slides)
    assert all(mean.max() < LIMIT for mean in means)
