"""Writes records in memory, numpy's structured types, as structs of C++."""

from typing import Any

from kernel.names import safe

_NUMBERS = {
    "f8": "double",
    "i8": "int64_t",
    "i4": "int32_t",
    "u1": "uint8_t",
    "u4": "uint32_t",
    "u8": "uint64_t",
}
_OF_LANES = {"f": "F", "i": "I"}


def struct(name: str, layout: Any) -> str:
    """Return the struct of a record; the compiler checks its size and the place of every field."""
    lines, checks = [], [f"static_assert(sizeof({name}) == {layout.itemsize});\n"]
    for field in layout.names:
        kind, place = layout.fields[field][:2]
        extent = "".join(f"[{length}]" for length in kind.shape)
        lines.append(f"    {_NUMBERS[kind.base.str[1:]]} {safe(field)}{extent};\n")
        checks.append(f"static_assert(__builtin_offsetof({name}, {safe(field)}) == {place});\n")
    return f"struct {name} {{\n{''.join(lines)}}};\n{''.join(checks)}"


def lane_struct(name: str, layout: Any) -> str:
    """Return the struct of a record in lanes, without its tables, and copies to and from a lane."""
    fields = [field for field in layout.names if not layout[field].shape]
    members = "".join(f"    {_OF_LANES[layout[field].kind]} {safe(field)};\n" for field in fields)
    copied = "".join(f"    to->{safe(field)} = from->{safe(field)};\n" for field in fields)
    lane = f"{name}Lanes<Spaced<double>, Spaced<int64_t>>*"
    return (
        f"template <class F, class I> struct {name}Lanes {{\n{members}}};\n"
        f"INLINE void copy_to_lane({lane} to, const {name}* from) {{\n{copied}}}\n"
        f"INLINE void copy_from_lane({name}* to, const {lane} from) {{\n{copied}}}\n"
    )
