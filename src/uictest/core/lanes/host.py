"""What the processor at hand can do."""

from functools import cache

_WIDTHS = (("avx512f", 8), ("avx", 4))
"""Extensions of x86 and how many double-precision numbers a register of theirs holds."""
_SMALLEST = 2
"""Numbers in a register of SSE2 and of Arm's NEON, which every 64-bit processor of their kind has."""


@cache
def register_width() -> int:
    """Return how many double-precision numbers a SIMD register of this processor holds."""
    from llvmlite import binding

    features = binding.get_host_cpu_features()
    return next((width for name, width in _WIDTHS if features.get(name)), _SMALLEST)


@cache
def fuses() -> bool:
    """Return whether this processor multiplies and adds in one instruction, as nearly all have since 2013."""
    from llvmlite import binding

    # Where every processor of a kind does so, it is not listed.
    return bool(binding.get_host_cpu_features().get("fma", True))
