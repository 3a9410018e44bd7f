"""Object files loaded into this process: by a loader of their own where that can be, else by LLVM.

LLVM takes longer to load than a stop to run, and code that needs nothing from outside needs little of it: its
sections are put into memory side by side and the addresses in them are set. That is done for 64-bit x86 under
Linux ("System V Application Binary Interface, AMD64 Architecture Processor Supplement", 4.4: relocation).
"""

import ctypes
import mmap
import platform
import struct
import sys
from collections.abc import Callable, Iterator
from typing import Any, Final, NamedTuple

from uictest.core.processor import processor

_RELOCATABLE, _X86_64 = 1, 62
_ALLOCATED = 2
_SYMBOLS, _STRINGS, _RELOCATIONS, _EMPTY = 2, 3, 4, 8
_ABSOLUTE, _RELATIVE, _RELATIVE_CALL, _RELATIVE_LONG = 1, 2, 4, 24
_UNWINDING: Final = frozenset({".eh_frame"})
"""Sections that only exceptions need; there are none."""
_ALIGNMENT: Final = 64
"""Bytes; no section asks for more."""


class LoadedCode(NamedTuple):
    """Code in this process.

    Attributes:
        address_of: returns the address of a function by its name.
        memory: what holds the code as long as it may be called.
    """

    address_of: Callable[[str], int]
    memory: Any


class UnsupportedObjectError(Exception):
    """An object file that the own loader does not load."""


def load_object_file(code: bytes) -> LoadedCode:
    """Load an object file that needs nothing from outside into this process."""
    try:
        return load_directly(code)
    except (UnsupportedObjectError, OSError):  # a system may forbid to run what was written
        return load_by_llvm(code)


def load_by_llvm(code: bytes) -> LoadedCode:
    """Load an object file by LLVM's own loader."""
    from llvmlite import binding

    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), target_machine(*processor()))
    engine.add_object_file(binding.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return LoadedCode(engine.get_function_address, engine)


def target_machine(name: str, features: str, *, in_library: bool = False) -> Any:
    """Return what generates code of LLVM for a processor, for this process or for a shared library."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    return binding.Target.from_default_triple().create_target_machine(
        cpu=name,
        features=features,
        opt=3,
        reloc="pic" if in_library else "default",
        codemodel="small" if in_library else "jitdefault",
        jit=not in_library,
    )


class _Section(NamedTuple):
    name: int
    kind: int
    flags: int
    address: int
    offset: int
    size: int
    link: int
    info: int
    alignment: int
    entry_size: int


_SECTION: Final = struct.Struct("<IIQQQQIIQQ")
_SYMBOL: Final = struct.Struct("<IBBHQQ")
_RELOCATION: Final = struct.Struct("<QIIq")


def load_directly(code: bytes) -> LoadedCode:
    """Load an object file by this module alone.

    Raises:
        UnsupportedObjectError: it is for another kind of machine, or needs what is not done here.
        OSError: the system does not let code be made.
    """
    if sys.platform != "linux" or platform.machine() != "x86_64":
        raise UnsupportedObjectError("another kind of machine")
    sections = _sections(code)
    places, size = _places(sections)
    memory = mmap.mmap(-1, size)
    start = ctypes.addressof(ctypes.c_char.from_buffer(memory))
    for number, place in places.items():
        section = sections[number]
        memory[place : place + section.size] = code[section.offset : section.offset + section.size]
    symbols = list(_symbols(code, sections, {number: start + place for number, place in places.items()}))
    for section in sections:
        if section.kind == _RELOCATIONS and section.info in places:
            _relocate(memory, start, places[section.info], _entries(code, section, _RELOCATION), symbols)
    _make_executable(start, size)
    addresses = {name: address for name, address in symbols if address is not None}
    return LoadedCode(addresses.__getitem__, memory)


def _sections(code: bytes) -> list[_Section]:
    """Return the sections of an object file of this kind of machine."""
    kind, machine = struct.unpack_from("<HH", code, 16)
    if code[:6] != b"\x7fELF\x02\x01" or (kind, machine) != (_RELOCATABLE, _X86_64):
        raise UnsupportedObjectError("not an object file of this kind of machine")
    (start,) = struct.unpack_from("<Q", code, 40)
    count, names = struct.unpack_from("<HH", code, 60)
    sections = [_Section(*_SECTION.unpack_from(code, start + _SECTION.size * n)) for n in range(count)]
    unused = {n for n, each in enumerate(sections) if _name(code, sections[names], each.name) in _UNWINDING}
    return [each._replace(flags=0) if n in unused else each for n, each in enumerate(sections)]


def _name(code: bytes, names: _Section, place: int) -> str:
    first = names.offset + place
    return code[first : code.index(b"\0", first)].decode()


def _places(sections: list[_Section]) -> tuple[dict[int, int], int]:
    """Return where each section that is loaded begins, and the size of them all."""
    places: dict[int, int] = {}
    end = 0
    for number, section in enumerate(sections):
        if section.flags & _ALLOCATED and section.size:
            if section.kind == _EMPTY or section.alignment > _ALIGNMENT:
                raise UnsupportedObjectError("a section without content, or of a large alignment")
            places[number] = -(-end // _ALIGNMENT) * _ALIGNMENT
            end = places[number] + section.size
    return places, end


def _entries(code: bytes, section: _Section, form: struct.Struct) -> Iterator[tuple[Any, ...]]:
    return form.iter_unpack(code[section.offset : section.offset + section.size])


def _symbols(
    code: bytes, sections: list[_Section], addresses: dict[int, int]
) -> Iterator[tuple[str, int | None]]:
    """Yield each symbol's name and its address, None for one that is not in a section that is loaded."""
    for table in sections:
        if table.kind != _SYMBOLS:
            continue
        for name, _, _, number, value, _ in _entries(code, table, _SYMBOL):
            place = addresses.get(number)
            yield _name(code, sections[table.link], name), None if place is None else place + value


def _relocate(
    memory: mmap.mmap,
    start: int,
    place: int,
    relocations: Iterator[tuple[Any, ...]],
    symbols: list[tuple[str, int | None]],
) -> None:
    """Set the addresses in one section, which begins at `place` of a memory that begins at `start`."""
    for offset, kind, symbol, addend in relocations:
        address = symbols[symbol][1]
        if address is None:
            raise UnsupportedObjectError(f"{symbols[symbol][0]} is not in the file")
        value, at = address + addend, place + offset
        if kind == _ABSOLUTE:
            struct.pack_into("<Q", memory, at, value)
        elif kind in (_RELATIVE, _RELATIVE_CALL):
            struct.pack_into("<i", memory, at, value - start - at)  # the sections are far closer than 2 GiB
        elif kind == _RELATIVE_LONG:
            struct.pack_into("<q", memory, at, value - start - at)
        else:
            raise UnsupportedObjectError(f"relocation {kind}")


def _make_executable(start: int, size: int) -> None:
    """Let memory be executed and no longer be written. Raises OSError."""
    system = ctypes.CDLL(None, use_errno=True)
    if system.mprotect(ctypes.c_void_p(start), ctypes.c_size_t(size), mmap.PROT_READ | mmap.PROT_EXEC):
        raise OSError(ctypes.get_errno(), "memory cannot be made executable")
