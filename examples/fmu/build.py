"""Make an FMU from a controller in C that uictest_controller.h describes.

    python build.py ../threshold-c/threshold.c --scenario ../threshold-c/threshold.yaml -o wsp.fmu --fmi 3

The parameters of the scenario's controller, which must be numbers, become parameters of the FMU; their values
there are its start values. The headers of FMI come with FMPy. A C compiler ($CC, else gcc) is needed.
"""

import argparse
import os
import subprocess
import tempfile
import uuid
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as Xml
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import fmpy
import yaml

import uictest

HERE = Path(__file__).parent
INCLUDES = (HERE, Path(uictest.__file__).parent / "controllers", Path(fmpy.__file__).parent / "c-code")
NUMBERS = {
    "wheel_speed": (0, "input", 4),
    "cylinder_pressure": (4, "input", 4),
    "brake_demand": (8, "input", 1),
    "wheel_radius": (9, "parameter", 4),
    "initial_speed": (13, "parameter", 1),
    "cycle_time": (14, "parameter", 1),
    "reference_speed": (15, "output", 1),
}
"""Name -> first value reference, causality, count; wsp.h has the same."""
WHOLES = {
    "speed_valid": (1000, "input", 4),
    "hold": (1004, "output", 4),
    "vent": (1008, "output", 4),
    "diagnosis": (1012, "output", 1),
}
TIME, FIRST_PARAMETER = 16, 17
START = {"wheel_radius": 0.46, "cycle_time": 0.01, "speed_valid": 1}
"""Start values that are not 0; wsp.c has the same."""
IDENTIFIER = "wsp"


def main() -> None:
    """Build as the command line says."""
    parser = argparse.ArgumentParser(description="Make an FMU from a controller in C.")
    parser.add_argument("source", type=Path, help="the controller")
    parser.add_argument("--scenario", type=Path, required=True, help="names the parameters")
    parser.add_argument("-o", "--output", type=Path, default=Path("wsp.fmu"))
    parser.add_argument("--fmi", type=int, choices=(2, 3), default=2, help="version of FMI")
    arguments = parser.parse_args()
    controller = yaml.safe_load(arguments.scenario.read_text("utf-8"))["controller"]
    declared = {name: each["default"] for name, each in controller.get("declared_parameters", {}).items()}
    given = declared | controller.get("parameters", {})
    parameters = {name: float(value) for name, value in given.items()}
    build(arguments.source, parameters, arguments.output, arguments.fmi)


def build(source: Path, parameters: Mapping[str, float], output: Path, fmi: int, *options: str) -> None:
    """Compile a controller and pack it; ``options`` go to the compiler."""
    token = str(uuid.uuid5(uuid.NAMESPACE_URL, f"{fmi} {source.read_text('utf-8')} {sorted(parameters)}"))
    with tempfile.TemporaryDirectory() as folder:
        binary = Path(folder) / f"{IDENTIFIER}{fmpy.sharedLibraryExtension}"
        (Path(folder) / "parameters.h").write_text(parameters_header(parameters, token), "utf-8")
        compile_library(source, Path(folder), binary, fmi, options)
        platform = fmpy.platform if fmi == 2 else fmpy.platform_tuple
        with ZipFile(output, "w") as archive:
            # No times, so that the same source gives the same file.
            for name, content in (
                ("modelDescription.xml", model_description(parameters, token, fmi)),
                (f"binaries/{platform}/{binary.name}", binary.read_bytes()),
            ):
                archive.writestr(ZipInfo(name), content, ZIP_DEFLATED)


def compile_library(source: Path, folder: Path, binary: Path, fmi: int, options: tuple[str, ...]) -> None:
    """Compile the controller and the functions of FMI into one library."""
    sources = [source, HERE / "wsp.c", HERE / f"fmi{fmi}.c", HERE / "unused.c"]
    includes = [f"-I{each}" for each in (folder, source.parent, *INCLUDES)]
    flags = ["-O2", "-ffp-contract=off", "-fPIC", "-shared", f"-DFMI={fmi}", *options]
    command = [os.environ.get("CC", "gcc"), *flags, *includes, *map(str, sources), "-o", str(binary), "-lm"]
    subprocess.run(command, check=True)


def parameters_header(parameters: Mapping[str, float], token: str) -> str:
    """Return parameters.h: what wsp.h says that it holds."""
    names = ", ".join(f'"{name}"' for name in parameters)
    values = ", ".join(repr(value) for value in parameters.values())
    return (
        f'#define INSTANTIATION_TOKEN "{token}"\n'
        f"#define PARAMETERS {len(parameters)}\n"
        f"#define LONGEST_PARAMETER_NAME {max(map(len, parameters), default=0)}\n"
        f"static const char *const PARAMETER_NAMES[PARAMETERS + 1] = {{{names or 0}}};\n"
        f"static const double PARAMETER_VALUES[PARAMETERS + 1] = {{{values or 0}}};\n"
    )


def model_description(parameters: Mapping[str, float], token: str, fmi: int) -> bytes:
    """Return modelDescription.xml."""
    described = list(variables(parameters))
    about = {"fmiVersion": f"{fmi}.0", "modelName": IDENTIFIER, "version": "1.0"}
    root = Xml.Element("fmiModelDescription", {**about, "guid" if fmi == 2 else "instantiationToken": token})
    Xml.SubElement(
        root, "CoSimulation", modelIdentifier=IDENTIFIER, canHandleVariableCommunicationStepSize="true"
    )
    listed = Xml.SubElement(root, "ModelVariables")
    add = _add_fmi2 if fmi == 2 else _add_fmi3
    for variable in described:
        add(listed, variable)
    _add_structure(root, described, fmi)
    return bytes(Xml.tostring(root, encoding="utf-8", xml_declaration=True))


def variables(parameters: Mapping[str, float]) -> Iterator[dict[str, Any]]:
    """Yield name, value reference, causality, type and start value of every variable."""
    for table, kind in ((NUMBERS, "Real"), (WHOLES, "Boolean")):
        for name, (first, causality, count) in table.items():
            for place in range(count):
                own = name if count == 1 else f"{name}_{place + 1}"
                type_ = "Integer" if name == "diagnosis" else kind
                start = START.get(name, 0)
                yield {
                    "name": own,
                    "vr": first + place,
                    "causality": causality,
                    "type": type_,
                    "start": start,
                }
    yield {"name": "time", "vr": TIME, "causality": "independent", "type": "Real", "start": 0.0}
    for place, (name, value) in enumerate(parameters.items()):
        reference = FIRST_PARAMETER + place
        yield {"name": name, "vr": reference, "causality": "parameter", "type": "Real", "start": value}


def _attributes(variable: Mapping[str, Any]) -> dict[str, str]:
    variability = {"parameter": "fixed", "independent": "continuous"}.get(variable["causality"], "discrete")
    return {
        "name": variable["name"],
        "valueReference": str(variable["vr"]),
        "causality": variable["causality"],
        "variability": variability,
    }


def _start(variable: Mapping[str, Any]) -> dict[str, str]:
    if variable["causality"] in ("output", "independent"):
        return {}
    value = variable["start"]
    return {"start": str(bool(value)).lower() if variable["type"] == "Boolean" else repr(value)}


def _add_fmi2(listed: Xml.Element, variable: Mapping[str, Any]) -> None:
    scalar = Xml.SubElement(listed, "ScalarVariable", _attributes(variable))
    Xml.SubElement(scalar, variable["type"], _start(variable))


def _add_fmi3(listed: Xml.Element, variable: Mapping[str, Any]) -> None:
    types = {"Real": "Float64", "Integer": "Int32", "Boolean": "Boolean"}
    Xml.SubElement(listed, types[variable["type"]], {**_attributes(variable), **_start(variable)})


def _add_structure(root: Xml.Element, described: list[dict[str, Any]], fmi: int) -> None:
    structure = Xml.SubElement(root, "ModelStructure")
    outputs = [(i, each) for i, each in enumerate(described, start=1) if each["causality"] == "output"]
    if fmi == 2:
        for section in ("Outputs", "InitialUnknowns"):
            parent = Xml.SubElement(structure, section)
            for index, _ in outputs:
                Xml.SubElement(parent, "Unknown", index=str(index))
    else:
        for section in ("Output", "InitialUnknown"):
            for _, variable in outputs:
                Xml.SubElement(structure, section, valueReference=str(variable["vr"]))


if __name__ == "__main__":
    main()
