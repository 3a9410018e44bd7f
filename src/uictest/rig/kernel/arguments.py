"""What compiled functions are called with: records and arrays in memory, tuples of them, whole numbers.

A function of C takes the lengths of arrays, addresses and whole numbers. The caller, who has arrays of numpy,
and the compiled function, which wants arrays, follow the same description of its arguments.
"""

import hashlib
from collections.abc import Iterator
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

Arguments = tuple[Any, ...]
"""For each argument an :func:`at`, `int` for a whole number, or a named tuple of such."""


class Length:
    """A length that the arrays of a call decide: a multiple of the number of that name, less a number."""

    __slots__ = ("factor", "less", "name")

    def __init__(self, name: str, factor: int = 1, less: int = 0) -> None:
        self.name, self.factor, self.less = name, factor, less

    def __rmul__(self, factor: int) -> "Length":
        return Length(self.name, factor * self.factor, factor * self.less)

    def __sub__(self, less: int) -> "Length":
        return Length(self.name, self.factor, self.less + less)

    def of(self, number: int) -> int:
        """Return the length for a number."""
        return self.factor * number - self.less

    def number(self, length: int) -> int:
        """Return the number that gives a length, if one does."""
        return (length + self.less) // self.factor


class At:
    """Layout of the memory at an address: one record; or, with a shape, an array of records or numbers."""

    __slots__ = ("layout", "shape")

    def __init__(self, layout: Any, *shape: int | Length) -> None:
        self.layout, self.shape = np.dtype(layout), shape

    def address_of(self, value: Any, numbers: dict[str, int]) -> int:
        """Return the address of a numpy record or array; the first array with a named length sets it.

        Args:
            value: the record or array.
            numbers: those of the lengths, by their names; added to here.

        Raises TypeError for another layout or shape: machine code does not check the memory at an address.
        """
        shape = tuple(
            size if isinstance(size, int) else size.of(numbers.setdefault(size.name, size.number(found)))
            for size, found in zip(self.shape, value.shape, strict=False)
        )
        fits = value.dtype == self.layout and value.shape == shape and len(shape) == len(self.shape)
        if not fits or not value.flags.c_contiguous:
            raise TypeError(f"expected {shape} contiguous {self.layout}, found {value.shape} {value.dtype}")
        # `__array_interface__` would say it, too, but lists all fields first, for tenths of a millisecond.
        return int(np.frombuffer(value, np.uint8).ctypes.data)


def at(layout: Any, *shape: int | Length) -> Any:
    """Return an :class:`At`; typed as what it stands for, a member of a tuple."""
    return At(layout, *shape)


def leaves(arguments: Arguments) -> Iterator[Any]:
    """Yield arguments, or what is given for them, with the members of tuples in place of the tuples."""
    for argument in arguments:
        if isinstance(argument, tuple):
            yield from leaves(argument)
        else:
            yield argument


def digest_of_layouts(arguments: Arguments) -> str:
    """Return a digest of all that arguments describe, the same for blocks of any number of lanes."""
    described = [
        each if each is int else (_fields_of(each.layout), len(each.shape)) for each in leaves(arguments)
    ]
    return hashlib.sha256(repr((described, lengths(arguments))).encode()).hexdigest()[:8]


def _fields_of(layout: Any) -> Any:
    if layout.names is None:
        return layout.str
    fields = [(name, layout[name].base.str, layout[name].shape) for name in layout.names]
    shapes = {shape for _, _, shape in fields}
    # Of a block every field has a number for each lane, and no other record has tables alone.
    in_lanes = len(shapes) == 1 and shapes != {()}
    return [field[:2] for field in fields] if in_lanes else fields


def lengths(arguments: Arguments) -> list[str]:
    """Return the names of all lengths in their order: a function of C takes these numbers first."""
    shapes = (each.shape for each in leaves(arguments) if isinstance(each, At))
    return list(dict.fromkeys(size.name for shape in shapes for size in shape if isinstance(size, Length)))


def passed(arguments: Arguments, values: Arguments) -> tuple[int, ...]:
    """Return the arguments of a call of a C function: lengths, then addresses and whole numbers.

    Args:
        arguments: what the function takes.
        values: records and arrays of numpy, whole numbers, and tuples of them, as described.

    Raises TypeError where a value does not have the layout or the shape described.
    """
    numbers: dict[str, int] = {}
    addresses_and_numbers = [
        value if argument is int else argument.address_of(value, numbers)
        for argument, value in zip(leaves(arguments), leaves(values), strict=True)
    ]
    return (*numbers.values(), *addresses_and_numbers)


def placed(arguments: Arguments, values: Arguments, *blocks: NDArray[Any]) -> Iterator[tuple[int, int]]:
    """Yield the arguments of a call of a C function for copies of these blocks of memory elsewhere.

    Args:
        arguments: what the function takes.
        values: as for :func:`passed`; every record and array lies in one of the blocks, or is empty.
        blocks: arrays in one piece.

    Yields:
        Number of a block, from 1, and an offset in it; or 0 and a plain number.
    """
    numbers = passed(arguments, values)
    count = len(numbers) - sum(1 for _ in leaves(arguments))
    sizes = [1 if isinstance(value, int) else value.nbytes for value in leaves(values)]
    yield from ((0, number) for number in numbers[:count])
    for number, argument, size in zip(numbers[count:], leaves(arguments), sizes, strict=True):
        if argument is int or size == 0:
            yield 0, number if argument is int else 0
            continue
        offsets = [number - int(block.__array_interface__["data"][0]) for block in blocks]
        [block] = [n for n, offset in enumerate(offsets) if 0 <= offset <= blocks[n].nbytes - size]
        yield block + 1, offsets[block]


CACHE_LINE = 64
"""Bytes; no vector of a block then lies across two cache lines."""


def block(layout: np.dtype[Any], width: int, count: int = 1) -> NDArray[Any]:
    """Return ``count`` zeroed records of ``width`` lanes each.

    Args:
        layout: structured type of one record; every number takes eight bytes (``f8`` or ``i8``). Fields of
            several numbers are left out: tables are for scalar code.
        width: number of lanes.
        count: number of records, such as the four wheelsets of a car.

    Returns:
        Structured array of shape (count,). Its fields have the names of ``layout`` and hold one number for
        each lane, side by side, so that a field is read into a register at once.
    """
    size = count * block_layout(layout, width).itemsize
    memory = np.zeros(size + CACHE_LINE, np.uint8)
    start = -memory.ctypes.data % CACHE_LINE
    return memory[start : start + size].view(block_layout(layout, width))


def block_layout(layout: np.dtype[Any], width: int) -> np.dtype[Any]:
    """Return the layout of a record of a block."""
    names = [name for name in layout.names or () if not layout[name].shape]
    return np.dtype([(name, layout[name], (width,)) for name in names])


def vectors(block: Any) -> Any:
    """Records of a block with all lanes at once as attributes; ``[i]`` gives the i-th."""
    _compiled_only()


def lane(block: Any, number: int) -> Any:
    """Records of a block as lane ``number`` holds them, numbers as attributes; ``[i]`` gives the i-th."""
    _compiled_only()


def copy_to_lane(place: Any, record: Any) -> None:
    """Set every field of one lane's record to that of an ordinary record, which must have them all."""
    _compiled_only()


def copy_from_lane(record: Any, place: Any) -> None:
    """Set those fields of an ordinary record that one lane's record has; it must have them all."""
    _compiled_only()


def _compiled_only() -> NoReturn:
    raise TypeError("the code of lanes runs compiled only; the model of one stop also runs in plain Python")
