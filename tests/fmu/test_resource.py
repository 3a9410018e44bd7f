"""The file that the library of an FMU reads: found wherever it lies, and refused where it is not whole."""

import ctypes
import shutil
import zipfile
import zlib
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.api.fmu.resource import ENUMERATIONS, FILE_NAME, HEAD, VARIABLE_ROW

from .test_building import described, extracted

LOGGER = ctypes.CFUNCTYPE(
    *(None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)
)


class Callbacks(ctypes.Structure):
    """`fmi2CallbackFunctions`."""

    _fields_ = (("logger", LOGGER), ("others", ctypes.c_void_p * 3), ("environment", ctypes.c_void_p))


class Fmu(NamedTuple):
    """The library of an FMU, and what it is told."""

    library: ctypes.CDLL
    token: bytes
    resources: Path
    content: bytes

    def why_not(self, location=None, content=None):
        """Return why no instance is made, empty where one is, of resources at a place or with a content."""
        (self.resources / "model.bin").write_bytes(self.content if content is None else content)
        heard = []
        callbacks = Callbacks(LOGGER(lambda *given: heard.append(given[-1].decode())))
        told = str(self.resources) if location is None else location
        made = self.library.fmi2Instantiate(
            *(b"x", 1, self.token, told and told.encode(), ctypes.byref(callbacks), 0, 0)
        )
        if made:
            self.library.fmi2FreeInstance(made)
        return "".join(heard)


@pytest.fixture(name="unpacked", scope="module")
def _unpacked(build, tmp_path_factory):
    folder = tmp_path_factory.mktemp("unpacked") / "wäre 100 % & #1"
    library = ctypes.CDLL(str(extracted(build(2), folder)))
    library.fmi2Instantiate.restype = ctypes.c_void_p
    library.fmi2FreeInstance.argtypes = [ctypes.c_void_p]
    content = (folder / FILE_NAME).read_bytes()
    return Fmu(library, described(build(2)).get("guid").encode(), folder / "resources", content)


def test_it_is_found_however_the_folder_is_named(unpacked):
    uri = unpacked.resources.as_uri()
    assert "%20" in uri
    path = uri.removeprefix("file://")
    told = [uri, f"{uri}/", f"file:{path}", f"file://localhost{path}", str(unpacked.resources)]
    told += [f"{unpacked.resources}/", uri.replace("%C3", "%c3")]
    assert [unpacked.why_not(each) for each in told] == [""] * len(told)


@pytest.mark.parametrize("location", ["", "file:", "file:///no/such/folder", "/" + "x" * 5000])
def test_a_folder_that_is_none_is_refused(unpacked, location):
    heard = unpacked.why_not(location)
    expected = ("expected the folder of the FMU's resources: ", "the file of the FMU cannot be read: ")
    assert heard.startswith(expected)


@given(place=st.integers(0, 10**9), mask=st.integers(1, 255))
def test_a_byte_that_is_another_is_found(unpacked, place, mask):
    content = bytearray(unpacked.content)
    content[place % len(content)] ^= mask
    assert unpacked.why_not(content=bytes(content)).startswith(
        ("the file of the FMU is ", "no file of an FMU of uictest: ")
    )


@given(length=st.integers(0, 10**9))
def test_a_file_that_ends_early_or_goes_on_is_refused(unpacked, length):
    cut = unpacked.content[: length % len(unpacked.content)]
    assert unpacked.why_not(content=cut) != ""
    assert unpacked.why_not(content=unpacked.content + bytes(1 + length % 100)).startswith(
        "the file of the FMU is damaged"
    )


def forged(content, change):
    """Return the file with another head or other rows, and the checksum that belongs to it."""
    file = bytearray(content)
    head = np.frombuffer(file, HEAD, 1)
    change(head[0], file)
    begin = HEAD.fields["size"][1]
    head["checksum"] = zlib.crc32(bytes(file[begin:]))
    return bytes(file)


FAR = (-8, 2**40, 2**62)
SECTIONS = ("variables", "arguments", "json", "memory", "constants", "texts")


def is_refused(unpacked, change):
    """Return whether a file that is changed so, with its checksum, is told as damaged."""
    told = unpacked.why_not(content=forged(unpacked.content, change))
    return told.startswith("the file of the FMU is damaged")


@pytest.mark.parametrize("far", FAR)
@pytest.mark.parametrize("section", SECTIONS)
def test_a_section_beyond_the_end_is_refused(unpacked, section, far):
    assert unpacked.why_not(content=forged(unpacked.content, lambda *same: None)) == ""
    for part in (0, 1):
        assert is_refused(unpacked, lambda head, file, part=part: head[section].__setitem__(part, far))


@pytest.mark.parametrize("far", FAR)
def test_a_variable_or_more_to_be_zeroed_than_the_memory_is_refused(unpacked, far):
    for name in ("begun", "kept"):
        assert is_refused(unpacked, lambda head, file, name=name: head.__setitem__(name, far))
    for field in ("name", "place"):

        def change(head, file, field=field):
            rows = np.frombuffer(file, VARIABLE_ROW, head["variables"][1], head["variables"][0])
            rows[field][3] = far

        assert is_refused(unpacked, change)


@pytest.mark.parametrize("far", [*FAR, "last"])
@pytest.mark.parametrize("name", ["exchange", "kept", "closed", "commands", "wheel_radius"])
def test_a_place_beyond_the_memory_is_refused(unpacked, name, far):
    def change(head, file):
        last = head["memory"][1] - (0 if name == "closed" else 8)
        head["places"][ENUMERATIONS["PLACE"].index(name)] = last if far == "last" else far

    assert is_refused(unpacked, change)


def test_the_file_of_another_fmu_is_refused_and_one_that_is_not_there_said_with_its_path(
    unpacked, build, tmp_path
):
    with zipfile.ZipFile(build(3)) as archive:
        other = archive.read(FILE_NAME)
    told = unpacked.why_not(content=other)
    assert told.startswith("the file is not of the same FMU as the model description")
    older = bytearray(unpacked.content)
    older[8] ^= 1
    told = unpacked.why_not(content=bytes(older))
    assert "is of another version of uictest than the shared library" in told
    shutil.copytree(unpacked.resources, tmp_path / "resources")
    (tmp_path / "resources/model.bin").unlink()
    heard = unpacked.why_not(str(tmp_path / "resources"))
    assert heard == f"the file of the FMU cannot be read: {tmp_path}/resources/model.bin"
