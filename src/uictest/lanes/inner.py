"""Functions that only compiled code calls: linked into their callers, without machine code of their own."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from uictest.lanes.compiler import Library, Pipeline, compiled


def compile_inner(function: Callable[..., Any], **options: Any) -> Any:
    """Compile a function that compiled code calls, and nothing else.

    Left out are its entries from Python and from C, and its machine code, which the code of its callers
    contains once more: together they would take longer than all else.

    Args:
        function: plain Python.
        options: those of `numba.njit`.
    """
    without_entries = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    return compiled(**options, **without_entries, pipeline_class=_LinkedOnly)(function)


class _LinkedCode(Library):  # type: ignore[misc]
    """Code that its callers link and optimise."""

    def _finalize_final_module(self) -> None:
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return that there is none."""
        return 0

    @property
    def codegen(self) -> Any:
        """What is told of the objects that errors are raised with: there is no place to keep them."""
        return SimpleNamespace(set_env=lambda name, environment: None)


class _LinkedOnly(Pipeline):  # type: ignore[misc]
    """Numba's own pipeline, with another end."""

    def __init__(self, typing_context: Any, target_context: Any, *others: Any) -> None:
        super().__init__(typing_context, target_context, *others)
        self.state.library = _LinkedCode(target_context.codegen(), "inner")
