"""The studies, in the order in which they are listed and run."""

from __future__ import annotations

from uictest.studies import (
    appendix_b,
    bench_loops,
    command_level,
    cylinder_dynamics,
    field_against_rig,
    force_accuracy,
    four_phase_lines,
    friction_level,
    rig_equivalence,
    robustness,
    slide_test,
    valve_actuations,
)
from uictest.studies.study import Study

STUDIES: dict[str, Study] = {
    module.STUDY.name: module.STUDY
    for module in (
        bench_loops,
        four_phase_lines,
        cylinder_dynamics,
        force_accuracy,
        command_level,
        friction_level,
        slide_test,
        valve_actuations,
        appendix_b,
        robustness,
        rig_equivalence,
        field_against_rig,
    )
}
"""Every study by its name."""
