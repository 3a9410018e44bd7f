"""Writes one plain Python function as a template of C++."""

import ast
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import FunctionType, ModuleType
from typing import TYPE_CHECKING

from kernel.names import UntranslatableError, bare, bracketed, is_number, literal, namespace, safe
from kernel.syntax import (
    calls,
    check_flow,
    is_read_first,
    is_truth,
    is_whole_literal,
    names_assigned,
    values_of,
)
from uictest.core.record import FieldCopier, FieldStarter

if TYPE_CHECKING:
    from kernel.cpp import Program

_BINARY = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.BitAnd: "&",
    ast.BitOr: "|",
    ast.BitXor: "^",
    ast.LShift: "<<",
    ast.RShift: ">>",
}
_COMPARE = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
_UNARY = {ast.USub: "-", ast.Not: "!", ast.Invert: "~", ast.UAdd: "+"}
_BUILTINS = {"int": "whole", "float": "real", "bool": "bool", "abs": "magnitude", "round": "nearest_even"}
_BUILTINS |= {"max": "larger", "len": "len"}
_CONTINUED = "\\"
"""At the end of a comment of C++ it makes the next line a part of it."""
_RETURNED = {"float": "double", "int": "int64_t"}


@cache
def _tree(path: str) -> ast.Module:
    return ast.parse(Path(path).read_text(encoding="utf-8") if Path(path).is_file() else "")


def place_of(function: FunctionType) -> str:
    """Return file and line of a function."""
    return f"{function.__code__.co_filename}:{function.__code__.co_firstlineno}"


def _definition(function: FunctionType) -> ast.FunctionDef:
    """Return the definition of a function in the file of its module, which must be there as it stands."""
    code = function.__code__
    for node in ast.walk(_tree(code.co_filename)):
        if isinstance(node, ast.FunctionDef):
            first = min([node.lineno, *(each.lineno for each in node.decorator_list)])
            if (first, node.name) == (code.co_firstlineno, code.co_name):
                return node
    raise UntranslatableError(
        f"{place_of(function)}: {code.co_name} is not written there; write it as a `def`"
    )


class _Part(ast.Name):
    """A variable that only the C++ has."""


class FunctionWriter:
    """One function being written."""

    def __init__(self, program: "Program", function: FunctionType) -> None:
        self.program, self.function = program, function
        self.tree = _definition(function)
        path = Path(function.__code__.co_filename)
        self.file = (
            path.relative_to(program.root).as_posix() if path.is_relative_to(program.root) else path.name
        )
        # Names of variables, of each block one dictionary: what they were first set to, if it is known.
        self.scopes: list[dict[str, ast.expr | None]] = [{}]
        self.parts = 0

    def text(self) -> str:
        """Return the template of the function."""
        arguments = self._arguments()
        self.scopes[0].update(dict.fromkeys(arguments))
        body, comment = self.tree.body, ""
        if isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
            first = str(body[0].value.value).strip().splitlines()[0]
            comment = f"// {first.rstrip(_CONTINUED)}\n"
            body = body[1:]
        name = safe(self.function.__name__)
        linkage = "OUTLINE" if self.function in self.program.outlined else "INLINE"
        head = f"{linkage} {self._result()} {name}({', '.join(f'auto {safe(each)}' for each in arguments)})"
        origin, space = f"// {self.file}:{self.tree.lineno}", namespace(self.function.__module__)
        lines = "".join(f"{line}\n" for line in self.block(body, []))
        check_flow(self.tree, self.refusal)
        return f"{origin}\n{comment}namespace {space} {{\n{head} {{\n{lines}}}\n}}\n"

    def _arguments(self) -> list[str]:
        taken = self.tree.args
        if taken.vararg or taken.kwarg or taken.kwonlyargs or taken.defaults or taken.posonlyargs:
            raise self.refusal(self.tree, "arguments by position only, without defaults")
        if self.tree.decorator_list or self.function.__closure__:
            raise self.refusal(self.tree, "a plain function of a module: no decorator, no closure")
        return [each.arg for each in taken.args]

    def _result(self) -> str:
        returns = [each for each in ast.walk(self.tree) if isinstance(each, ast.Return) and each.value]
        if not returns:
            return "void"
        annotation = ast.unparse(self.tree.returns) if self.tree.returns else ""
        return _RETURNED.get(annotation, "auto") if len(returns) > 1 else "auto"

    def refusal(self, node: ast.AST, instead: str) -> UntranslatableError:
        """Return the error for a construct."""
        written = ast.unparse(node).splitlines()[0]
        line = getattr(node, "lineno", self.tree.lineno)
        return UntranslatableError(f"{self.file}:{line}: `{written}` cannot be compiled; write {instead}")

    # Statements: each method returns lines of C++; `after` are the statements behind.

    def block(self, body: list[ast.stmt], after: list[ast.stmt]) -> list[str]:
        """Return the lines of statements, each with its place, which the compiler names."""
        lines = []
        for n, statement in enumerate(body):
            written = self.statement(statement, body[n + 1 :] + after)
            if written:
                lines += [f'#line {statement.lineno} "{self.file}"', *(_indented(line) for line in written)]
        return lines

    def inner(self, body: list[ast.stmt], after: list[ast.stmt], **names: None) -> list[str]:
        """Return the lines of a block with variables of its own."""
        self.scopes.append(dict(names))
        lines = self.block(body, after)
        self.scopes.pop()
        return lines

    def statement(self, node: ast.stmt, after: list[ast.stmt]) -> list[str]:
        """Return the lines of a statement."""
        match node:
            case ast.Expr(value=ast.Constant()):
                return []
            case ast.Expr(value=ast.Call()):
                return [f"{self.expression(node.value)};"]
            case ast.Return(value=None):
                return ["return;"]
            case ast.Return():
                return [f"return {self.value(node.value)};"]
            case ast.Continue() | ast.Break():
                return [f"{ast.unparse(node)};"]
            case ast.Assign():
                return self.assignments(node)
            case ast.AnnAssign(value=ast.expr() as value):
                return self.assign(node.target, value)
            case ast.AugAssign():
                return self.augmented(node)
            case ast.If():
                return self.branch(node, after)
            case ast.While(orelse=[]):
                head = f"while ({self.test(node.test)}) {{"
                return [*self.hoisted(node, after), head, *self.inner(node.body, after), "}"]
            case ast.For(orelse=[], target=ast.Name()):
                return self.loop(node, after)
        raise self.refusal(node, "assignments, calls, if, while, for over a range or over numbers, return")

    def assignments(self, node: ast.Assign) -> list[str]:
        """Return the lines of an assignment; `a = b = value` sets the first target first."""
        if len(node.targets) == 1:
            return self.assign(node.targets[0], node.value)
        lines, value = [], node.value
        if not isinstance(value, ast.Constant):
            part = self.unused()
            lines.append(f"auto {part} = {self.value(value)};")
            value = _Part(part)
        return [*lines, *(line for target in node.targets for line in self.assign(target, value))]

    def augmented(self, node: ast.AugAssign) -> list[str]:
        """Return the lines of `a += b`, as `a = a + b`: C++ evaluates the right side of `+=` first."""
        lines, target = [], node.target
        if isinstance(target, ast.Subscript):
            indices = target.slice.elts if isinstance(target.slice, ast.Tuple) else [target.slice]
            kept = [_Part(self.unused()) if calls(index) else index for index in indices]
            pairs = zip(kept, indices, strict=True)
            lines = [
                f"auto {each.id} = {self.value(index)};" for each, index in pairs if isinstance(each, _Part)
            ]
            target = ast.Subscript(target.value, kept[0] if len(kept) == 1 else ast.Tuple(kept))
        if calls(target):
            raise self.refusal(node, "no call on the left, but a variable that is set before")
        return [*lines, *self.assign(target, ast.BinOp(target, node.op, node.value))]

    def assign(self, target: ast.expr, value: ast.expr) -> list[str]:
        """Return the lines that set a variable, which is declared if it is new, a field, or a member."""
        match target:
            case ast.Tuple():
                return self.unpack(target, value)
            case ast.Name(id=name) if not self.known(name):
                text = self.value(value)
                self.scopes[-1][name] = value
                return [f"auto {safe(name)} = {text};"]
            case ast.Name(id=name) if is_truth(self.first(name)) and not is_truth(value):
                raise self.refusal(value, f"`bool(...)` around it, as `{name}` is a truth; or another name")
            case ast.Name() | ast.Attribute():
                pass
            case ast.Subscript() if not isinstance(target.slice, ast.Slice):
                pass
            case _:
                raise self.refusal(target, "variables, fields or single members on the left")
        return [f"{self.expression(target)} = {self.kept(value)};"]

    def unpack(self, target: ast.Tuple, value: ast.expr) -> list[str]:
        """Return the lines that set several variables or fields to the members of a tuple."""
        names = [each.id for each in target.elts if isinstance(each, ast.Name)]
        new = len(names) == len(target.elts) and not any(self.known(name) for name in names)
        if isinstance(value, ast.Tuple):
            members = self.members(value.elts)
            if len(members) != len(target.elts):
                raise self.refusal(target, f"{len(members)} names on the left")
            if new or all(isinstance(each, ast.Constant) for each in members):
                # What is new is read nowhere on the right, so that one may be set after the other.
                pairs = zip(target.elts, members, strict=True)
                return [line for each, part in pairs for line in self.assign(each, part)]
        text = self.value(value)
        if new:
            bound = [self.unused() if name == "_" else safe(name) for name in names]
            self.scopes[-1].update((name, None) for name in names if name != "_")
            return [f"auto [{', '.join(bound)}] = {text};"]
        parts = [self.unused() for _ in target.elts]
        pairs = zip(target.elts, map(_Part, parts), strict=True)
        set_one_by_one = [line for each, part in pairs for line in self.assign(each, part)]
        return [f"auto [{', '.join(parts)}] = {text};", *set_one_by_one]

    def unused(self) -> str:
        """Return a name that nothing else has: no name of Python becomes one with this end."""
        self.parts += 1
        return f"part_{self.parts}_"

    def branch(self, node: ast.If, after: list[ast.stmt]) -> list[str]:
        """Return the lines of an if with all its branches."""
        lines = self.hoisted(node, after)
        lines += [f"if ({self.test(node.test)}) {{", *self.inner(node.body, after)]
        if node.orelse:
            lines += ["} else {", *self.inner(node.orelse, after)]
        return [*lines, "}"]

    def loop(self, node: ast.For, after: list[ast.stmt]) -> list[str]:
        """Return the lines of a loop over a range, or over numbers that are written down."""
        assert isinstance(node.target, ast.Name)
        name, lines = node.target.id, self.hoisted(node, after)
        match node.iter:
            case ast.Tuple(elts=numbers) if all(isinstance(each, ast.Constant) for each in numbers):
                whole = all(
                    isinstance(each, ast.Constant) and isinstance(each.value, int) for each in numbers
                )
                members = ", ".join(map(self.expression, numbers))
                kind = "int64_t" if whole else "double"
                head = f"for ({kind} {safe(name)} : (const {kind}[]){{{members}}}) {{"
            case ast.Call(func=ast.Name(id="range"), args=[*bounds], keywords=[]) if 0 < len(
                bounds
            ) < 3 and self.is_builtin("range"):
                first, last = (["0", *map(self.kept, bounds)])[-2:]
                counter = safe(name)
                head = f"for (int64_t {counter} = {first}, end_ = {last}; {counter} < end_; ++{counter}) {{"
            case _:
                raise self.refusal(
                    node, "`for name in range(...)`, with one bound or two, or numbers in brackets"
                )
        return [*lines, head, *self.inner(node.body, after, **{name: None}), "}"]

    def hoisted(self, node: ast.stmt, after: list[ast.stmt]) -> list[str]:
        """Declare what is first set within a statement and read behind it."""
        lines = []
        for name in dict.fromkeys(names_assigned(node)):
            if self.known(name) or not is_read_first(name, after):
                continue
            value = next(filter(self.can_be_typed, values_of(name, node)), None)
            if value is None:
                raise self.refusal(node, f"`{name} = ...` before it, with a value of the same kind")
            lines.append(f"decltype(get({self.value(value)})) {safe(name)};")
            self.scopes[-1][name] = value
        return lines

    def can_be_typed(self, value: ast.expr) -> bool:
        """Whether all variables of an expression are there."""
        names = {each.id for each in ast.walk(value) if isinstance(each, ast.Name)}
        return all(self.known(name) for name in names & {*self.function.__code__.co_varnames})

    def known(self, name: str) -> bool:
        """Whether a name is that of a variable."""
        return any(name in scope for scope in self.scopes)

    def first(self, name: str) -> ast.expr | None:
        """Return what a variable was first set to, if it is known."""
        return next(scope[name] for scope in reversed(self.scopes) if name in scope)

    def is_builtin(self, name: str) -> bool:
        """Whether a name stands for what Python has under it."""
        return not self.known(name) and name not in self.function.__globals__

    # Expressions: each method returns C++.

    def test(self, node: ast.expr) -> str:
        """Return an expression of which only the truth counts, without the brackets around all of it."""
        return bare(self.truth(node))

    def truth(self, node: ast.expr) -> str:
        """Return an expression of which only the truth counts."""
        match node:
            case ast.BoolOp():
                return self.joined(node, self.truth)
            case ast.UnaryOp(op=ast.Not()):
                return f"!{self.truth(node.operand)}"
        return self.expression(node)

    def joined(self, node: ast.BoolOp, operand: Callable[[ast.expr], str]) -> str:
        """Return operands joined by `and` or `or`."""
        sign = " && " if isinstance(node.op, ast.And) else " || "
        return f"({sign.join(map(operand, node.values))})"

    def known_truth(self, node: ast.expr) -> str:
        """Return an operand of `and` whose value is kept: Python keeps the operand, C++ a truth."""
        return self.expression(node) if is_truth(node) else f"truth({self.kept(node)})"

    def kept(self, node: ast.expr) -> str:
        """Return an expression whose value is stored where its type is known."""
        text = bare(self.expression(node))
        return f"get({text})" if isinstance(node, ast.Attribute | ast.Subscript) else text

    def value(self, node: ast.expr | None) -> str:
        """Return an expression whose value is passed or is a new variable's: whole numbers have 64 bits."""
        assert node is not None
        return f"int64_t({self.expression(node)})" if is_whole_literal(node) else self.kept(node)

    def expression(self, node: ast.expr) -> str:
        """Return an expression."""
        match node:
            case ast.Constant(value=bool() | int() | float()) if is_number(node.value):
                return literal(node.value)
            case _Part(id=name):
                return name
            case ast.Name():
                return safe(node.id) if self.known(node.id) else self.constant(node)
            case ast.Attribute():
                return self.attribute(node)
            case ast.Subscript():
                return self.subscript(node)
            case ast.Tuple():
                return f"tuple_of({', '.join(map(self.value, self.members(node.elts)))})"
            case ast.Call(keywords=[]):
                return self.call(node)
            case ast.BinOp():
                return self.operator(node)
            case ast.UnaryOp(op=ast.Not()):
                return self.truth(node)
            case ast.UnaryOp() if not is_truth(node.operand):
                operand = self.expression(node.operand)
                return f"{_UNARY[type(node.op)]}{bracketed(operand)}"
            case ast.BoolOp():
                return self.joined(node, self.known_truth)
            case ast.Compare() if all(type(each) in _COMPARE for each in node.ops):
                return self.comparison(node)
            case ast.IfExp():
                return f"({self.truth(node.test)} ? {self.value(node.body)} : {self.value(node.orelse)})"
        raise self.refusal(
            node, "numbers, fields, members, calls without keywords, operators, `a if b else c`"
        )

    def constant(self, node: ast.Name) -> str:
        """Return the constant of a module."""
        if node.id in self.function.__code__.co_varnames:
            raise self.refusal(node, f"`{node.id} = ...` before, on every path that comes here")
        if node.id not in self.function.__globals__:
            raise self.refusal(node, "a variable or a constant of the module")
        value, place = self.function.__globals__[node.id], f"{self.file}:{node.lineno}"
        return self.program.constant(self.function.__module__, node.id, value, place)

    def attribute(self, node: ast.Attribute) -> str:
        """Return a field of a record, or a constant of a module."""
        if isinstance(node.value, ast.Name) and not self.known(node.value.id):
            holder = self.function.__globals__.get(node.value.id)
            if isinstance(holder, ModuleType) and hasattr(holder, node.attr):
                value, place = getattr(holder, node.attr), f"{self.file}:{node.lineno}"
                return self.program.constant(holder.__name__, node.attr, value, place)
        return f"{self.expression(node.value)}->{safe(node.attr)}"

    def subscript(self, node: ast.Subscript) -> str:
        """Return a member of a tuple, of a table, or of an array."""
        base = self.expression(node.value)
        match node.slice:
            case ast.Slice(lower=ast.expr() as lower, upper=ast.expr() as upper, step=None):
                return f"slice({base}, {self.index(lower)}, {self.index(upper)})"
            case ast.Slice():
                raise self.refusal(node, "both bounds of a slice, and no step")
            case ast.Tuple(elts=indices):
                return f"at({base}, {', '.join(map(self.index, indices))})"
            case ast.Constant(value=int() as number):
                return f"item<{number}>({base})"
        return f"at({base}, {self.index(node.slice)})"

    def index(self, node: ast.expr) -> str:
        """Return an index, counted from the front."""
        if isinstance(node, ast.UnaryOp):
            raise self.refusal(node, "an index counted from the front")
        return self.kept(node)

    def members(self, nodes: list[ast.expr]) -> list[ast.expr]:
        """Return arguments or members, those of starred tuples in place of the tuples."""
        members: list[ast.expr] = []
        for node in nodes:
            match node:
                case ast.Starred(value=ast.Tuple(elts=inner)):
                    members += self.members(inner)
                case ast.Starred(value=ast.Name(id=name)) if self.known(name):
                    written = self.first(name)
                    if not isinstance(written, ast.Tuple):
                        raise self.refusal(node, "`*` before a tuple that is written down in this function")
                    count = len(self.members(written.elts))
                    members += [ast.Subscript(node.value, ast.Constant(n)) for n in range(count)]
                case ast.Starred():
                    raise self.refusal(node, "`*` before a tuple that is written down in this function")
                case _:
                    members.append(node)
        return members

    def call(self, node: ast.Call) -> str:
        """Return a call: of a function, of a named tuple, of one in a table of functions."""
        given = [self.value(each) for each in self.members(node.args)]
        module = self.function.__globals__
        match node.func:
            case ast.Attribute(value=ast.Subscript(value=ast.Name(id=table), slice=row), attr=field):
                if not self.known(table) and isinstance(module.get(table), tuple):
                    chosen = self.program.choice(module[table], field, table)
                    return f"{chosen}({', '.join([self.value(row), *given])})"
            case ast.Name(id=name) if not self.known(name):
                target = module.get(name)
                if self.is_builtin(name) and name in _BUILTINS:
                    return f"{_BUILTINS[name]}({', '.join(given)})"
                if isinstance(target, type) and len(getattr(target, "_fields", ())) == len(given) > 0:
                    return f"{self.program.named_tuple(target)}{{{', '.join(given)}}}"
                if (
                    isinstance(target, FunctionType | FieldCopier | FieldStarter)
                    or target in self.program.replaced
                ):
                    return f"{self.program.function(target)}({', '.join(given)})"
        raise self.refusal(
            node, "a call of a function of this package, of a named tuple, of int, float, abs, len ..."
        )

    def operator(self, node: ast.BinOp) -> str:
        """Return an operator with its operands; division and remainder are those of Python."""
        left, right = self.expression(node.left), self.expression(node.right)
        of_truths = is_truth(node.left) or is_truth(node.right)
        if of_truths and not isinstance(node.op, ast.BitAnd | ast.BitOr | ast.BitXor):
            raise self.refusal(node, "select(..., 1, 0) in place of a truth: in lanes it is no number")
        match node.op:
            case ast.Div():
                return f"(real({left}) / {right})"
            case ast.FloorDiv():
                return f"floor_divided({left}, {right})"
            case ast.Mod():
                return f"modulo({left}, {right})"
            case ast.Add() if isinstance(node.right, ast.Constant) and isinstance(node.right.value, float):
                left = f"real({left})"  # whole numbers of lanes and a float give floats
            case _ if is_whole_literal(node.left) and (
                is_whole_literal(node.right) or isinstance(node.op, ast.LShift)
            ):
                left = f"int64_t({left})"
        if type(node.op) not in _BINARY:
            raise self.refusal(node, "products in place of powers")
        return f"({left} {_BINARY[type(node.op)]} {right})"

    def comparison(self, node: ast.Compare) -> str:
        """Return a comparison; of a chain each link."""
        if any(map(calls, node.comparators[:-1])):
            raise self.refusal(node, "variables in the middle: what is called there would be called twice")
        terms = [self.expression(each) for each in (node.left, *node.comparators)]
        signs = (_COMPARE[type(each)] for each in node.ops)
        links = [f"({a} {sign} {b})" for a, sign, b in zip(terms, signs, terms[1:], strict=False)]
        return links[0] if len(links) == 1 else f"({' && '.join(links)})"


def _indented(line: str) -> str:
    return line if line.startswith("#line") else f"    {line}"
