"""Which program a controller from outside is, from the parameters of its part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final, get_args

from uictest.controllers import Kind
from uictest.judging.evaluation.parameters import EffectivePart

_KINDS: Final = get_args(Kind)


@dataclass(frozen=True, slots=True)
class Program:
    """A controller that is no part of this package.

    Args:
        name: of its part: as its file calls it, else its class, its file or its address.
        kind: python, library, fmu, connect or registered.
        source: its file as the scenario writes it, its address, or its registered name.
        version: as its scenario, its file or its package states it, else as it said itself; empty where none
            of them does.
        sha256: of its file; empty where there is none.
        told_version: what it said of itself where that is not `version`; empty where both agree.

    """

    name: str
    kind: str
    source: str
    version: str
    sha256: str
    told_version: str = ""

    def telling(self, version: str) -> Program:
        """Return the program once it has said this version of itself in a stop, empty for none."""
        stated = self.version or version
        return replace(self, version=stated, told_version="" if version == stated else version)


def program_of(part: EffectivePart, told: str = "") -> Program | None:
    """Return the program of a controller from outside; None for any other part.

    `told` is the version that it said of itself in a stop, empty where that is not known.
    """
    values = {each.key.removeprefix(f"{part.key}."): str(each.value) for each in part.parameters}
    kind = next((kind for kind in _KINDS if kind in values), None)
    if part.kind != "controller" or kind is None:
        return None
    stated = values.get("version", ""), values.get("sha256", "")
    return Program(part.name, kind, values[kind], *stated).telling(told)


def program_in(parts: Mapping[str, EffectivePart], told: str = "") -> Program | None:
    """Return the program among the parts of a case, by role; None where its controller is built in.

    `told` as for :func:`program_of`.
    """
    controller = parts.get("controller")
    return None if controller is None else program_of(controller, told)
