"""Keep results of studies in the package, for the dossier of an assessor.

    ./reproduce; python scripts/dossier_studies.py reports/studies/studies.json

Studies that the file does not hold keep the results that are kept. Run it for a release.
"""

import argparse
import json
import sys
from pathlib import Path

REPOSITORY = Path(__file__).parents[1]
sys.path.insert(0, str(REPOSITORY))

from studies.study import STUDIES  # noqa: E402
from uictest import __version__  # noqa: E402
from uictest.selftest.dossier import RESULTS  # noqa: E402


def main() -> None:
    """Merge the results of the named file into those of the package, in the order of the catalogue."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("results", type=Path, help="studies.json of ./reproduce")
    run = json.loads(parser.parse_args().results.read_text("utf-8"))
    kept = json.loads(RESULTS.read_text("utf-8")) if RESULTS.is_file() else run
    found = {each["name"]: each for each in (*kept["studies"], *run["studies"])}
    studies = [found[name] for name in STUDIES if name in found]
    content = {"schema": run["schema"], "version": __version__, "studies": studies}
    RESULTS.write_text(json.dumps(content, indent=1) + "\n", "utf-8")
    print(f"{RESULTS}: {len(studies)} of {len(STUDIES)} studies")


if __name__ == "__main__":
    main()
