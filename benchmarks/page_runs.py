"""Run folders with as many cases as wanted: some real stops, repeated under other names."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from stops import SCENARIOS

RUNS = ([], ["--set", "rig.wsp=bypassed"])
"""Arguments of the runs that the stops come from; without slide protection many of them fail."""
ENTRY_POINT = "import sys; from uictest.cli import main; sys.exit(main())"
"""What the installed script `uictest` does."""


def stops_in(folder: Path) -> list[tuple[dict[str, Any], Path]]:
    """Return the documents of runs of the shipped scenarios, and where their recordings lie."""
    found = []
    for number, extra in enumerate(RUNS):
        output = folder / f"run-{number}"
        words = ["run", str(SCENARIOS), *extra, "--record", "all", "-o", str(output)]
        subprocess.run([sys.executable, "-c", ENTRY_POINT, *words], capture_output=True, check=False)
        run = output / "latest"
        found.append((json.loads((run / "results.json").read_text("utf-8")), run / "recordings"))
    return found


def run_folder(folder: Path, sources: list[tuple[dict[str, Any], Path]], cases: int) -> Path:
    """Write a run of `cases` cases; those that are named first keep their recordings. Return its folder."""
    document = {key: value for key, value in sources[0][0].items() if key != "series"}
    document |= {"cases": [], "subjects": {}, "parts": {}}
    (folder / "recordings").mkdir(parents=True)
    for source, _ in sources:
        document["parts"] |= source["parts"]
    for (case, subject, recording), number in zip(_repeated(sources), range(cases), strict=False):
        name = f"{case['id']}[copy={number:04}]"
        document["cases"].append({**case, "id": name})
        document["subjects"][name] = subject
        if recording.is_file() and number < len(sources[0][0]["cases"]):
            (folder / "recordings" / f"{name}.parquet").symlink_to(recording)
    (folder / "results.json").write_text(json.dumps(document), encoding="utf-8")
    return folder


def _repeated(sources: list[tuple[dict[str, Any], Path]]) -> Iterator[tuple[dict[str, Any], Any, Path]]:
    """Yield the cases of all sources again and again, one of each in turn."""
    while True:
        for place in range(len(sources[0][0]["cases"])):
            for document, recordings in sources:
                case = document["cases"][place]
                yield case, document["subjects"].get(case["id"], {}), recordings / f"{case['id']}.parquet"
