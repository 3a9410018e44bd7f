"""Builds the kernel when the package is built or installed, and names the wheel by its platform."""

import os
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parent / "src")]


class CustomBuildHook(BuildHookInterface):
    """Puts the library, and those of FMUs, beside the Python files that use them."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the library of this machine, or of the target that the variable UICTEST_TARGET names."""
        from kernel import build, fmu
        from kernel.names import UntranslatableError

        if self.target_name != "wheel":
            return
        try:
            if version == "editable":
                build.build_package()
                return
            name = os.environ.get("UICTEST_TARGET") or build.host()
            library = build.build_library(name, build.OBJECTS / name)
            libraries_of_fmus = fmu.build_libraries(build.OBJECTS / "fmu")
        except (build.BuildError, UntranslatableError) as error:
            self.app.abort(str(error))
        # Not into the sources: there this machine's own may lie.
        build_data["force_include"] |= {
            str(library): f"uictest/rig/kernel/{library.name}",
            **{str(each): f"uictest/api/fmu/binaries/{each.name}" for each in libraries_of_fmus},
        }
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{build.TARGETS[name].wheel_tag}"
