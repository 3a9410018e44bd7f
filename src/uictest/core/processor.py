"""The processor of this machine as LLVM names it, without LLVM where that was asked before.

Loading LLVM takes longer than a stop. What it says follows from the processor and from what the system lets
programs use of it; where the system tells both, the answer is kept in the user's cache.
"""

import json
import os
import platform
from functools import cache
from typing import Final, NamedTuple

from uictest.core import user_cache
from uictest.core.distributions import distribution_version

_KIND: Final = "processor"
_MODALIAS: Final = "/sys/devices/system/cpu/modalias"
"""Linux: maker, family, model and every feature that the kernel found or left on."""


class Processor(NamedTuple):
    """A processor.

    Attributes:
        name: its name for LLVM.
        features: instructions beyond those of that name, as LLVM writes them, such as `+avx2,-sse4a`.
    """

    name: str
    features: str

    def has(self, feature: str, *, unlisted: bool = False) -> bool:
        """Return whether it has a feature; `unlisted` where LLVM does not list it."""
        listed = self.features.split(",")
        return f"+{feature}" in listed or (unlisted and f"-{feature}" not in listed)


@cache
def processor() -> Processor:
    """Return the processor of this process."""
    known_by = _known_by()
    kept = user_cache.read(_KIND, known_by) if known_by else None
    if kept is not None:
        return Processor(*json.loads(kept))
    answer = _asked()
    if known_by:
        user_cache.write(_KIND, known_by, json.dumps(answer).encode())
    return answer


def _asked() -> Processor:
    from llvmlite import binding

    return Processor(binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten())


def _known_by() -> bytes:
    """Return everything that LLVM's answer depends on; empty where the system does not tell."""
    try:
        with open(_MODALIAS, "rb", buffering=0) as file:  # noqa: PTH123
            features = file.read()
    except OSError:
        return b""
    # The kernel numbers the features: another release may number them differently.
    words = (platform.machine(), os.uname().release, distribution_version("llvmlite"))
    return repr(words).encode() + features
