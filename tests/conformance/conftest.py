"""Controllers that miss one fact each: changes of the first controller that `uictest init` writes."""

from collections.abc import Callable
from functools import partial

import pytest

from uictest import selftest
from uictest.plans import templates
from uictest.plans.scenario import load_controller
from uictest.rig.external import workers
from uictest.selftest import conformance
from uictest.selftest.conformance import bench as situations

Examine = Callable[..., selftest.Examination]


@pytest.fixture
def here(monkeypatch):
    """Drive controllers in this process: they fail in none of their cycles."""
    monkeypatch.setattr(workers, "_is_isolated", lambda program: False)


@pytest.fixture
def examine(tmp_path, monkeypatch):
    """Examine the first controller in Python with one stretch of its text replaced by another.

    Its cycles take four times as long as those of the library, so that each drive has a quarter as many: as
    many cycles has the one with random inputs.
    """
    monkeypatch.setattr(situations, "anything", partial(situations.anything, cycles=750))

    def changed(before="", after="", time_limit="60 s"):
        files = templates.controller_files("python")
        assert before in files["my_wsp.py"]
        (tmp_path / "my_wsp.py").write_text(files["my_wsp.py"].replace(before, after, 1), "utf-8")
        part = tmp_path / "my-wsp.yaml"
        part.write_text(f"{files['my-wsp.yaml']}cycle_time: 40 ms\ntime_limit: {time_limit}\n", "utf-8")
        return conformance.examine(conformance.subject_of("changed", load_controller(str(part))))

    return changed
