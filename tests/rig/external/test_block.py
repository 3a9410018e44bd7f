"""Stops in one block: in lanes where the controller says that it runs beside others, else one by one."""

import json
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

from uictest.controllers import EXCHANGE
from uictest.controllers.adapters import python_class
from uictest.plans.scenario import load, load_part
from uictest.rig import lanes
from uictest.rig.assembly import assemble
from uictest.rig.external.in_process import BlockInputs, run_block, run_in_process
from uictest.rig.external.workers import Workers

from ...c_compiler import build_library
from ...stop_bits import stop_bits

ENTRY_POINTS = "[uictest.controllers]\nacme-class = bad:Bad\n"
TWIN = Path(__file__).parents[3] / "examples" / "threshold-c" / "threshold.c"


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """Install a package with a class that fails as told to."""
    site = tmp_path_factory.mktemp("site")
    metadata = site / "acme_lanes-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: acme-lanes\nVersion: 1.0\n", "utf-8")
    (metadata / "entry_points.txt").write_text(ENTRY_POINTS, "utf-8")
    shutil.copy(Path(__file__).parent / "bad.py", site)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(site))
        patch.setenv("PYTHONPATH", str(site))
        python_class._registered_class.cache_clear()
        yield
    python_class._registered_class.cache_clear()
    sys.modules.pop("bad", None)


@pytest.fixture(scope="module")
def _twin(tmp_path_factory):
    library = tmp_path_factory.mktemp("twin") / "libtwin.so"
    build_library(library, TWIN)
    return library


@pytest.fixture
def twin(folder, _twin):
    """Put the threshold controller in C into the working folder."""
    return shutil.copy(_twin, folder)


@pytest.fixture
def ran_in_lanes(monkeypatch):
    """How many stops ran in lanes, for each call."""
    counts = []
    original = lanes.run_in_lanes

    def counted(parameters, *others):
        counts.append(len(parameters))
        return original(parameters, *others)

    monkeypatch.setattr(lanes, "run_in_lanes", counted)
    return counts


def twins(*frictions):
    """Stops with the threshold controller in C, on rails that need it."""
    part = load_part("controllers/threshold")
    own = {name: float(value) for name, value in part if isinstance(value, float) and name != "cycle_time"}
    written = f"{{library: libtwin.so, parameters: {json.dumps(own)}, free_parameters: true}}"
    return stops(written, *frictions)


def stops(controller, *frictions):
    rails = [f"rail={{condition: wet, friction: {friction}}}" for friction in frictions]
    return [assemble(load([Path("stop.yaml")], [rail, f"controller={controller}"])[0]) for rail in rails]


def bits(run, place=()):
    measures, of_wheelsets = run.measures[place], run.wheelset_measures[place]
    return bytes(measures.tobytes() + of_wheelsets.tobytes())


@pytest.mark.usefixtures("package", "twin")
def test_machine_code_runs_in_lanes_with_the_bits_of_a_stop_alone(library, ran_in_lanes):
    """Whatever stands between them in the block; a class of a package runs one by one."""
    library()
    frictions = (0.06, 0.08, 0.11)
    inputs = [
        *twins(*frictions),
        *stops("{registered: acme-class, parameters: {fault: none, at: 0}}", 0.08),
        *stops("threshold", *frictions),
        *stops("{library: libbad.so, parameters: {fault: none, at: 0}}", 0.08),
        *twins(0.14),
    ]
    run = run_block(BlockInputs.of(inputs))
    assert run.failures == [""] * 9
    assert ran_in_lanes == [8]
    for place, stop in enumerate(inputs):
        assert bits(run, place) == bits(run_in_process(stop)), place
    twin, own = (
        [stop_bits(run.measures[[place]], run.wheelset_measures[place]) for place in places]
        for places in ((0, 1, 2), (4, 5, 6))
    )
    assert twin == own


@pytest.mark.usefixtures("folder")
def test_no_stop_is_blamed_for_a_failure_that_another_notes_on_it(library):
    library()
    bad = "{{library: libbad.so, parameters: {{fault: {}, at: 7}}}}"
    inputs = [*stops(bad.format("none"), 0.08), *stops(bad.format("others-forbidden"), 0.08)]
    told = "controller: some controller of the process wrote beyond its outputs"
    assert run_block(BlockInputs.of(inputs)).failures == [told, ""]


@pytest.mark.usefixtures("package", "twin")
def test_a_controller_that_fails_ends_its_own_stop_alone(library, ran_in_lanes):
    library()
    inputs = [
        *stops("{library: libbad.so, parameters: {fault: create, at: 0}}", 0.08),
        *twins(0.08),
        *stops("{registered: acme-class, parameters: {fault: raise, at: 7}}", 0.08),
        *stops("{registered: acme-class, parameters: {fault: create, at: 0}}", 0.08),
        *twins(0.06),
    ]
    exchanges = np.zeros(5, EXCHANGE)
    run = run_block(BlockInputs.of(inputs), exchanges)
    expected = (
        "controller: uictest_create failed: ",
        "",
        "controller: step failed: ValueError: told to",
        "controller: Bad(config) failed: ValueError: told to",
        "",
    )
    for found, beginning in zip(run.failures, expected, strict=True):
        assert found.startswith(beginning)
        assert bool(found) == bool(beginning)
    assert ran_in_lanes == [2]
    assert not exchanges["calling"].any()
    for place in (1, 4):
        assert bits(run, place) == bits(run_in_process(inputs[place]))


@pytest.mark.usefixtures("package", "folder")
def test_a_block_in_a_child_process_has_the_bits_of_one_here(library):
    """Of a library, whose stops run in lanes, and of a class, whose stops run one by one."""
    library()
    inputs = [
        stop
        for kind in ("library: libbad.so", "registered: acme-class")
        for stop in stops(f"{{{kind}, parameters: {{fault: none, at: 0}}}}", 0.06, 0.09)
    ]
    with Workers() as workers:
        there = workers.run_block(BlockInputs.of(inputs))
    assert there.failures == [""] * 4
    assert bits(there) == bits(run_block(BlockInputs.of(inputs)))
