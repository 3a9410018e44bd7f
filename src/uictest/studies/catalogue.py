"""Find the studies: every module of the folder `experiments` defines one, named `STUDY`."""

from __future__ import annotations

import pkgutil
from importlib import import_module

from uictest.studies import experiments
from uictest.studies.study import Study


def find_studies() -> dict[str, Study]:
    """Return every study by its name, in the order in which they are listed and run."""
    modules = (
        import_module(f"{experiments.__name__}.{module.name}")
        for module in pkgutil.iter_modules(experiments.__path__)
    )
    studies: list[Study] = sorted((module.STUDY for module in modules), key=lambda study: study.position)
    return {study.name: study for study in studies}


STUDIES: dict[str, Study] = find_studies()
"""Every study by its name."""
