"""The loop that docs/rig.md shows runs on an FMU."""

import re
import subprocess
import sys
from pathlib import Path

PAGE = Path(__file__).parents[2] / "docs" / "rig.md"


def test_the_loop_of_the_page_stops_the_train(build, tmp_path):
    program = re.search(r"# close_loop.py\n.*?(?=^```$)", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    assert program is not None
    (tmp_path / "rig.fmu").write_bytes(build(2).read_bytes())
    done = subprocess.run(
        [sys.executable, "-c", program[0]], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert float(done.stdout.removesuffix(" m\n")) > 50.0
