"""Choose one of the cases of a scenario."""

from collections.abc import Sequence

from uictest.plans.scenario.model import Case
from uictest.plans.scenario.yaml import suggestion


def chosen_case(cases: Sequence[Case], case_id: str | None) -> Case:
    """Return the case of an id, or the only one. Raises ValueError."""
    ids = [case.id for case in cases]
    if case_id is None:
        if len(cases) != 1:
            raise ValueError(f"the scenario has {len(cases)} cases: pass case= one of {', '.join(ids)}")
        return cases[0]
    if case_id not in ids:
        raise ValueError(f"no case {case_id!r}; {suggestion(case_id, ids)}")
    return cases[ids.index(case_id)]
