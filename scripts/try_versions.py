"""Test the package with other versions of what it needs, in an environment of its own.

    python scripts/try_versions.py oldest   # the lowest versions that pyproject.toml allows
    python scripts/try_versions.py newest   # the newest of each

It answers what `uictest selftest` knows and passes some tests; arguments after `--` go to pytest.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import tomllib
import venv
from collections.abc import Sequence
from pathlib import Path

from packaging.requirements import Requirement

REPOSITORY = Path(__file__).parents[1]
EXTRAS = ("build", "figures", "mdf", "tdms", "mat", "fmu", "dask")
TOOLS = ("hypothesis", "jsonschema", "junitparser", "openpyxl", "pytest")
"""What the tests below need besides, in any version."""
TESTS = (
    *(
        "tests/kernel/test_library.py",
        "tests/scenario",
        "tests/recording",
        "tests/statistics",
        "tests/identification",
    ),
    *("tests/evaluation", "tests/rig/test_compiled.py", "tests/rig/test_lanes.py"),
    *("tests/report/formats", "tests/sweeps/summaries", "tests/cli/commands/test_run.py", "tests/stepping"),
)
OTHER_TEXT = "tests/scenario/test_json_schema.py::test_the_committed_schema_is_that_of_the_models"
"""Earlier versions of pydantic write the same JSON Schema in other words."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the environment, test in it, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("versions", choices=("oldest", "newest"))
    parser.add_argument("tests", nargs="*", default=TESTS, metavar="-- TEST")
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="uictest-versions-") as folder:
        python = installed(chosen.versions, Path(folder))
        # Nothing that was identified with other versions is found, and nothing is left for them.
        environment = {**os.environ, "UICTEST_CACHE": str(Path(folder, "cache"))}
        run = [
            str(python),
            "-m",
            "pytest",
            "-q",
            "-W",
            "default",
            "-p",
            "no:cacheprovider",
            "--deselect",
            OTHER_TEXT,
        ]
        for command in ([str(python), "-m", "uictest", "selftest"], [*run, *chosen.tests]):
            code = subprocess.run(command, cwd=REPOSITORY, env=environment, check=False).returncode
            if code != 0:
                return code
    return 0


def installed(versions: str, folder: Path) -> Path:
    """Return the interpreter of a new environment."""
    venv.create(folder / "environment", with_pip=False)
    python = folder / "environment" / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
    pip = [sys.executable, "-m", "pip", "--python", str(python), "install", "--quiet"]
    constraints = folder / "constraints.txt"
    constraints.write_text("\n".join(lowest()) if versions == "oldest" else "", encoding="utf-8")
    package = f"{REPOSITORY}[{','.join(EXTRAS)}]"
    subprocess.run([*pip, "--constraint", str(constraints), "--editable", package, *TOOLS], check=True)
    return python


def requirements() -> list[Requirement]:
    """Return what the package needs directly, with the extras that are tested."""
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    return [Requirement(text) for text in (*project["dependencies"], *(e for x in EXTRAS for e in extras[x]))]


def lowest() -> list[str]:
    """Return `name==version` of the lowest version that is allowed of every package."""
    return [
        f"{each.name}=={next(one.version for one in each.specifier if one.operator in ('>=', '=='))}"
        for each in requirements()
    ]


if __name__ == "__main__":
    sys.exit(main())
