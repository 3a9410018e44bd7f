"""Files of formats that are not read: known by their first bytes, and readable once the message is obeyed."""

import bz2
import gzip
import lzma
import zipfile

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, strategies as st

from uictest.core.recording.formats import Dialect, UnreadableError, read_contents
from uictest.core.recording.formats.file_formats import format_of
from uictest.core.recording.formats.isolation import read_here
from uictest.core.recording.formats.pieces import read_pieces

TIME = np.arange(100) * 0.1
SPEED = 20.0 - TIME
TABLE = "t,v_train\ns,m/s\n" + "".join(f"{t:.1f},{v:.1f}\n" for t, v in zip(TIME, SPEED, strict=True))

BEGINNINGS = {
    "imc FAMOS: export it as CSV": b"|CF,2,1,1;|CK,1,3,1,1;\r\n|NO,1,86,0,78,imc STUDIO",
    "imc FAMOS": b"|CK,1,3,1,1;",
    "Vector BLF: it holds frames of a bus: decode them with their DBC": b"LOGG\x90\0\0\0\x01",
    "Vector ASC: it holds frames of a bus": b"date Mon Jun 1 1:00:00.000 am 2026\r\nbase hex  timestamps",
    "Vector ASC": b"date Mon Jun 1 12:00:00.000 2026\nbase dec  timestamps relative\n",
    "PEAK TRC: it holds frames of a bus": b";$FILEVERSION=1.1\n;$STARTTIME=43000.5\n",
    "candump log: it holds frames of a bus": b"(1436509052.249713) can0 123#DEADBEEF\n",
    "Excel or OpenDocument workbook: save its sheet as CSV": b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
    "HTML page: save its table as CSV": b"\n<!DOCTYPE html>\n<html>",
    "HTML page": b"<html xmlns:o='urn:schemas-microsoft-com:office:office'>",
    "compressed file: unpack it": b"\x28\xb5\x2f\xfd\x04\x58",
    "compressed file": b"7z\xbc\xaf\x27\x1c\0\x04",
    "compressed file: ": b"Rar!\x1a\x07\x01\0",
    "DIAdem TDM: save it as TDMS": b'<?xml version="1.0" encoding="UTF-8" standalone="no" ?>\r\n<usi:tdm ',
    "SIE of HBM or nCode: export it": b"\0\0\x01\0\0\0\0\0\x51\xed\xa7\xa0<?xml",
    "HDF5, not MAT 7.3: write its channels as CSV or Parquet": b"\x89HDF\r\n\x1a\n\0\0\0",
    "Arrow or Feather: write it as Parquet": b"ARROW1\0\0",
    "text of Octave: save it with save -7": b"# Created by Octave 6.4.0, Mon Jun 01 12:00:00 2026",
    "PDF": b"%PDF-1.7\n",
}


@pytest.mark.parametrize("suffix", [".csv", ".mat", ".mf4", ".raw"])
@pytest.mark.parametrize("message", BEGINNINGS)
def test_a_format_is_named_by_its_first_bytes_whatever_its_suffix(tmp_path, message, suffix):
    path = tmp_path / f"record{suffix}"
    path.write_bytes(BEGINNINGS[message] + bytes(300))
    with pytest.raises(UnreadableError, match=f"^{message}"):
        read_contents(path)
    with pytest.raises(UnreadableError, match=f"^{message}"):
        next(read_pieces(path, Dialect()))


ODD_NAMES = ["LOGGER,MATLAB 1", "MATLAB time,v", "date,base", "PK,BZh", "(1.5) can,v", "|CF|,v"]


@pytest.mark.parametrize("names", [*ODD_NAMES, "html,v", "7z,Rar!", "%PDF,v"])
def test_a_table_whose_names_are_like_such_beginnings_is_read(tmp_path, names):
    path = tmp_path / "table.csv"
    path.write_text(f"{names}\n1,2\n")
    assert len(read_here(format_of(path), path, Dialect()).groups[0].channels) == 2


@given(st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs"]), min_size=1, max_size=40))
def test_no_text_of_names_is_taken_for_another_format(tmp_path_factory, names):
    path = tmp_path_factory.mktemp("table") / "table.csv"
    path.write_text(f"{names},time\n1,2\n", encoding="utf-8")
    assert format_of(path) == "csv"


def _speed(path):
    [group] = read_contents(path).groups
    return group.channels["v_train"]


def _compressed(suffix, opened):
    def write(folder):
        path = folder / f"stop.csv{suffix}"
        with opened(path, "wt") as file:
            file.write(TABLE)
        return path

    def unpack(path):
        with opened(path, "rb") as file:
            path.with_suffix("").write_bytes(file.read())
        return path.with_suffix("")

    return "compressed file: unpack it, and name the file inside$", write, unpack


def _zip(folder):
    with zipfile.ZipFile(folder / "stop.zip", "w") as archive:
        archive.writestr("stop.csv", TABLE)
    return folder / "stop.zip"


def _unzipped(path):
    with zipfile.ZipFile(path) as archive:
        archive.extractall(path.parent)
    return path.with_suffix(".csv")


def _workbook(engine):
    def write(folder):
        frame, path = pd.DataFrame({"t [s]": TIME, "v_train [m/s]": SPEED}), folder / "stop.xlsx"
        pytest.importorskip(engine)
        frame.to_excel(path, index=False, engine=engine)
        return path

    def save_as_csv(path):
        pd.read_excel(path).to_csv(path.with_suffix(".csv"), index=False)
        return path.with_suffix(".csv")

    return "Excel or OpenDocument workbook: save its sheet as CSV$", write, save_as_csv


def _feather(folder):
    pd.DataFrame({"t": TIME, "v_train": SPEED}).to_feather(folder / "stop.feather")
    return folder / "stop.feather"


def _as_parquet(path):
    pd.read_feather(path).to_parquet(path.with_suffix(".parquet"))
    return path.with_suffix(".parquet")


def _hdf5(folder):
    with pytest.importorskip("h5py").File(folder / "stop.mat", "w") as file:
        file["v_train"] = SPEED
    return folder / "stop.mat"


def _channels_as_csv(path):
    with pytest.importorskip("h5py").File(path) as file:
        lines = [str(value) for value in file["v_train"][:]]
    path.with_suffix(".csv").write_text("\n".join(["v_train", *lines]))
    return path.with_suffix(".csv")


OBEYED = {
    "gz": _compressed(".gz", gzip.open),
    "bz2": _compressed(".bz2", bz2.open),
    "xz": _compressed(".xz", lzma.open),
    "zip": ("compressed file: unpack it", _zip, _unzipped),
    "openpyxl": _workbook("openpyxl"),
    "xlsxwriter": _workbook("xlsxwriter"),
    "feather": (r".*pandas\.read_feather\(FILE\)\.to_parquet", _feather, _as_parquet),
    "hdf5": (r"HDF5, not MAT 7\.3: write its channels as CSV or Parquet", _hdf5, _channels_as_csv),
}
"""What the message says, what writes a file that is refused, and what does as the message says."""


@pytest.mark.parametrize("name", OBEYED)
def test_what_is_refused_is_read_once_the_message_is_obeyed(tmp_path, name):
    message, write, obey = OBEYED[name]
    path = write(tmp_path)
    with pytest.raises(UnreadableError, match=f"^{message}"):
        read_contents(path)
    np.testing.assert_allclose(_speed(obey(path)), SPEED, atol=1e-9)


def test_tables_of_measuring_programs_are_text_and_others_once_they_are_renamed(tmp_path):
    for suffix in (".lvm", ".tab", ".prn", ".asc"):
        path = tmp_path / f"stop{suffix}"
        path.write_text(TABLE)
        np.testing.assert_allclose(_speed(path), SPEED, atol=1e-9)
    for name in ("stop.log", "stop", "stop.mat"):
        path = tmp_path / name
        path.write_text(TABLE)
        told = r"MAT files \(versions 4 to 7\.3\) and texts .*; give a table of text one of these suffixes"
        with pytest.raises(UnreadableError, match=told):
            read_contents(path)
        np.testing.assert_allclose(_speed(path.rename(tmp_path / "stop.txt")), SPEED, atol=1e-9)


DATABASE = """VERSION ""

NS_ :

BS_:

BU_: T

BO_ 256 Speeds: 8 T
 SG_ v_train : 0|16@1+ (0.01,0) [0|100] "m/s" T
"""


@pytest.fixture
def bus_log(tmp_path):
    """An MDF file with a group of raw CAN frames, which hold the speed in 0.01 m/s, and of other signals."""
    asammdf = pytest.importorskip("asammdf")
    constants = pytest.importorskip("asammdf.blocks.v4_constants")
    fields = [("BusChannel", "u1"), ("ID", "<u4"), ("IDE", "u1"), ("DLC", "u1"), ("DataLength", "u1")]
    kind = [(f"CAN_DataFrame.{name}", each) for name, each in fields]
    frames = np.zeros(len(TIME), [*kind, ("CAN_DataFrame.DataBytes", "(8,)u1")])
    for name, value in (("BusChannel", 1), ("ID", 256), ("DLC", 8), ("DataLength", 8)):
        frames[f"CAN_DataFrame.{name}"] = value
    raw = np.round(SPEED * 100).astype("<u2")
    frames["CAN_DataFrame.DataBytes"][:, :2] = raw.view("u1").reshape(-1, 2)
    source = asammdf.Source("CAN", "CAN", "", constants.SOURCE_BUS, constants.BUS_TYPE_CAN)

    def write(*others):
        path = tmp_path / "bus.mf4"
        with asammdf.MDF(version="4.10") as mdf:
            mdf.append(asammdf.Signal(frames, TIME, name="CAN_DataFrame", source=source), acq_source=source)
            mdf.groups[0].channel_group.flags |= constants.FLAG_CG_BUS_EVENT
            for name in others:
                mdf.append([asammdf.Signal(SPEED, TIME, name=name, unit="m/s")])
            mdf.save(path)
        return path

    return write


def test_raw_frames_of_a_bus_are_refused_and_read_once_they_are_decoded(bus_log, tmp_path):
    asammdf = pytest.importorskip("asammdf")
    path = bus_log()
    with pytest.raises(UnreadableError, match="'CAN_DataFrame' holds raw frames of a bus: decode") as caught:
        read_contents(path)
    with pytest.raises(UnreadableError, match="raw frames of a bus"):
        next(read_pieces(path, Dialect()))
    (tmp_path / "bus.dbc").write_text(DATABASE)
    databases = {"CAN": [(tmp_path / "bus.dbc", 0)]}
    assert "mdf.extract_bus_logging({'CAN': [('bus.dbc', 0)]}).save('signals.mf4')" in str(caught.value)
    with asammdf.MDF(path) as mdf, mdf.extract_bus_logging(databases) as decoded:
        decoded.save(tmp_path / "signals.mf4")
    np.testing.assert_allclose(_speed(tmp_path / "signals.mf4"), SPEED, atol=0.006)


def test_signals_beside_raw_frames_are_read(bus_log):
    path = bus_log("v_train")
    contents = read_contents(path)
    assert [list(group.channels) for group in contents.groups] == [["v_train"]]
    assert list(contents.skipped) == ["CAN_DataFrame"]
    [piece] = read_pieces(path, Dialect())
    assert list(piece.groups[0].channels) == ["v_train"]
