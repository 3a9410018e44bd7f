"""Write the bill of materials of a released wheel, as CycloneDX in JSON.

    python scripts/sbom.py dist/uictest-0.2.0-py3-none-any.whl

The wheel is installed without extras into an environment of its own, and `cyclonedx-py` lists what is there.
Needs `cyclonedx-bom`, which no user of uictest does: pip install cyclonedx-bom
"""

import argparse
import subprocess
import sys
import tempfile
import venv
from collections.abc import Sequence
from pathlib import Path

REPOSITORY = Path(__file__).parents[1]


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the bill of materials beside the wheel, or where `--output` says."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("wheel", type=Path)
    parser.add_argument("-o", "--output", type=Path, help="file [default: beside the wheel]")
    chosen = parser.parse_args(arguments)
    output = chosen.output or chosen.wheel.with_suffix(".cdx.json")
    with tempfile.TemporaryDirectory(prefix="uictest-sbom-") as folder:
        python = installed(chosen.wheel, Path(folder))
        subprocess.run([*listing(python), "--output-file", str(output.absolute())], check=True)
    print(output)


def installed(wheel: Path, folder: Path) -> Path:
    """Return the interpreter of an environment that holds the wheel, what it needs, and nothing else."""
    venv.create(folder, with_pip=False)
    python = folder / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
    name, version = wheel.name.split("-")[:2]
    # By name and version, not by path: the path of a wheel would become part of the list.
    links = ["--find-links", str(wheel.absolute().parent), f"{name}=={version}"]
    pip = [sys.executable, "-m", "pip", "--python", str(python), "install", "--quiet"]
    subprocess.run([*pip, *links], check=True)
    return python


def listing(python: Path) -> list[str]:
    """Return the command that lists an environment: the same text for the same packages."""
    command = [sys.executable, "-m", "cyclonedx_py", "environment", str(python)]
    return [*command, "--pyproject", str(REPOSITORY / "pyproject.toml"), "--output-reproducible"]


if __name__ == "__main__":
    main()
