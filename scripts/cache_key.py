"""Print `key=...` for a CI service that caches compiled code: another version or processor, another key.

Compiled code depends on the sources, the compiler and the processor. uictest checks all three itself; the key
only saves a service from keeping files that this job cannot use.
"""

from __future__ import annotations

import hashlib
import platform
from importlib.metadata import distribution, version

from llvmlite import binding


def main() -> None:
    """Print the key of the installed uictest on this processor."""
    # RECORD has the digest of every installed file: it tells two states of one version apart.
    made_of = [distribution("uictest").read_text("RECORD") or "", version("numba"), platform.python_version()]
    processor = [binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten()]
    names = [version("uictest"), _digest(made_of), _digest(processor)]
    print(f"key=uictest-{'-'.join(names)}")


def _digest(texts: list[str]) -> str:
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:12]


if __name__ == "__main__":
    main()
