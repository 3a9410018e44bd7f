"""Runs and recordings to compare."""

import dataclasses

import numpy as np

from uictest.core.recording import Recording
from uictest.judging.evaluation import CaseResult, RepeatedStop, Repeats
from uictest.plans.scenario import PASS
from uictest.report import RunContent, RunManifest

from ..report.builders import make_result, make_verdict

STOP = make_result(id="dry-120", scenario="dry.yaml", parameters={})
FIGURES = STOP.measures | {"braking_distance_m": 465.0}
WHEELSETS = (STOP.wheelsets[0],) * 2


def make_run(name="run", case_id="dry-120", outcome="pass", verdict="pass", **figures):
    """A run of one case, its figures changed as asked."""
    own = {"id": case_id, "outcome": outcome, "criteria": (make_verdict(status=verdict),)}
    result = dataclasses.replace(STOP, **own, measures=FIGURES | figures, wheelsets=WHEELSETS)
    manifest = RunManifest(seed=0, versions={"numpy": "2.3.1"}, inputs={"dry.yaml": "a" * 64})
    return RunContent(name, [result], manifest)


def make_recording(interval=0.1, end=10.0, **channels):
    """Ten seconds of braking; channels given replace those there are."""
    time = np.arange(0.0, end + interval / 2, interval)
    own = {"time": time, "speed": 30.0 - time, "slide_1": np.sin(time)}
    units = {"time": "s", "speed": "m/s", "slide_1": "1"}
    return Recording({**own, **channels}, {**units, **{n: units.get(n, "1") for n in channels}}, {})


def make_repeated(distances, case_id="slip", noise_key="00c0ffee", **changes):
    """A case that was repeated under these seeds: the braking distance (m) of each stop."""
    stops = tuple(
        RepeatedStop(seed, "pass", "", (), FIGURES | {"braking_distance_m": distance}, WHEELSETS)
        for seed, distance in distances.items()
    )
    result = CaseResult(case_id, "slip.yaml", {}, PASS, "pass", noise_key=noise_key)
    medians = {"measures": stops[0].measures, "wheelsets": WHEELSETS}
    return dataclasses.replace(result, **medians, repeats=Repeats("all", stops), **changes)
