"""Keep results of studies in the package, for the dossier of an assessor.

    ./reproduce; python scripts/dossier_studies.py reports/studies/studies.json

Studies that the files do not hold keep the results that are kept; one without any is kept with the reason
`--why`. Run it for a release.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import Any, Final

REPOSITORY = Path(__file__).parents[1]
sys.path.insert(0, str(REPOSITORY))

from studies.study import STUDIES, Study  # noqa: E402
from uictest import __version__  # noqa: E402
from uictest.selftest.dossier import RESULTS  # noqa: E402

SCHEMA: Final = "uictest/kept-studies/1"
_WHY: Final = "nobody has run it for this build"


def main() -> None:
    """Merge the results of the named file into those of the package, in the order of the catalogue."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("results", type=Path, nargs="*", help="studies.json of ./reproduce")
    parser.add_argument("--why", default=_WHY, help="why a study without a result was not run [%(default)s]")
    given = parser.parse_args()
    runs = [json.loads(path.read_text("utf-8")) for path in given.results]
    kept = json.loads(RESULTS.read_text("utf-8"))["studies"]
    found = {each["name"]: each for each in kept if each["quantities"]}
    found |= {each["name"]: {**each, "version": __version__} for run in runs for each in run["studies"]}
    studies = [found.get(name) or not_run(study, given.why) for name, study in STUDIES.items()]
    content = {"schema": SCHEMA, "studies": studies}
    RESULTS.write_text(json.dumps(content, indent=1) + "\n", "utf-8")
    print(f"{RESULTS}: {sum(bool(each['quantities']) for each in studies)} of {len(STUDIES)} studies")


def not_run(study: Study, why: str) -> dict[str, Any]:
    """Return the entry of a study that has no result."""
    asked = {"name": study.name, "title": study.title, "source": study.paper}
    return {**asked, "result": "not run", "why": why, "quantities": [], "notes": []}


if __name__ == "__main__":
    main()
