"""What the syntax of a function says without its types: which variables are set where, what is a truth.

In Python a variable is one for the whole function; C++ has a scope for each block instead.
"""

import ast
from collections.abc import Callable, Iterator, Sequence

Refusal = Callable[[ast.AST, str], Exception]


def names_set(*nodes: ast.AST) -> Iterator[str]:
    """Yield the names that are set in nodes of a syntax tree."""
    for node in nodes:
        for each in ast.walk(node):
            if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store):
                yield each.id


def names_assigned(node: ast.AST) -> Iterator[str]:
    """Yield the names that assignments within a node set."""
    for each in ast.walk(node):
        if isinstance(each, ast.Assign | ast.AnnAssign):
            yield from names_set(each)


def values_of(name: str, node: ast.AST) -> Iterator[ast.expr]:
    """Yield what a variable alone is set to within a node."""
    for each in ast.walk(node):
        if (
            isinstance(each, ast.Assign)
            and isinstance(each.targets[0], ast.Name)
            and each.targets[0].id == name
        ):
            yield each.value


def check_flow(tree: ast.FunctionDef, refusal: Refusal) -> None:
    """Refuse a function that reads what is not set on every path, or that returns a value on some only."""
    arguments = {each.arg for each in tree.args.args}
    flow = _Flow(arguments | set(names_set(*tree.body)), refusal)
    ends = flow.after(tree.body, frozenset(arguments)) is not None
    if ends and any(isinstance(each, ast.Return) and each.value for each in ast.walk(tree)):
        raise refusal(tree, "`return` with a value at the end of every path")


class _Flow:
    """Finds what is set behind statements; None: nothing comes behind them."""

    def __init__(self, variables: set[str], refusal: Refusal) -> None:
        self.variables, self.refusal = variables, refusal

    def after(self, statements: Sequence[ast.stmt], known: frozenset[str]) -> frozenset[str] | None:
        """Return what is set behind statements if this is set before."""
        now: frozenset[str] | None = known
        for statement in statements:
            if now is None:
                raise self.refusal(statement, "nothing behind `return`, `break` or `continue`")
            now = self._after(statement, now)
        return now

    def _after(self, node: ast.stmt, known: frozenset[str]) -> frozenset[str] | None:
        match node:
            case ast.If():
                self._read(node.test, known)
                ways = self.after(node.body, known), self.after(node.orelse, known)
                going_on = [way for way in ways if way is not None]
                return frozenset.intersection(*going_on) if going_on else None
            case ast.While():
                self._read(node.test, known)
                self.after(node.body, known)
                return known
            case ast.For(target=ast.Name(id=name)):
                self._read(node.iter, known)
                if name in known or name in names_set(*node.body):
                    raise self.refusal(node, "a name that only this loop sets, and only at its head")
                self.after(node.body, known | {name})
                return known
            case ast.AugAssign(target=ast.Name(id=name)):
                self._read(ast.Name(name, ast.Load(), lineno=node.lineno), known)
        self._read(node, known)
        return None if isinstance(node, ast.Return | ast.Break | ast.Continue) else known | {*names_set(node)}

    def _read(self, node: ast.AST, known: frozenset[str]) -> None:
        for each in ast.walk(node):
            if not isinstance(each, ast.Name) or not isinstance(each.ctx, ast.Load):
                continue
            if each.id in self.variables and each.id not in known:
                raise self.refusal(each, f"`{each.id} = ...` before, on every path that comes here")


def is_read_first(name: str, statements: Sequence[ast.stmt]) -> bool:
    """Whether a variable is read in statements before it is set anew."""
    for node in statements:
        match node:
            case ast.For(target=ast.Name(id=target)):
                if _reads(node.iter, name) or (target != name and is_read_first(name, node.body)):
                    return True
            case ast.While() | ast.If():
                if _reads(node.test, name) or any(
                    is_read_first(name, way) for way in (node.body, node.orelse)
                ):
                    return True
            case ast.AugAssign(target=ast.Name(id=target)) if target == name:
                return True
            case _ if _reads(node, name):
                return True
            case ast.Assign() if name in names_set(*node.targets):
                return False
    return False


def _reads(node: ast.AST, name: str) -> bool:
    return any(
        isinstance(each, ast.Name) and each.id == name and isinstance(each.ctx, ast.Load)
        for each in ast.walk(node)
    )


def calls(node: ast.expr) -> bool:
    """Whether a function is called in an expression."""
    return any(isinstance(each, ast.Call) for each in ast.walk(node))


def is_whole_literal(node: ast.expr) -> bool:
    """Whether an expression is a whole number that is written down, maybe with a sign."""
    match node:
        case ast.UnaryOp(op=ast.USub() | ast.UAdd() | ast.Invert(), operand=operand):
            return is_whole_literal(operand)
        case ast.Constant(value=bool()):
            return False
    return isinstance(node, ast.Constant) and isinstance(node.value, int)


def is_truth(node: ast.expr | None) -> bool:
    """Whether an expression is a truth, whatever its parts are."""
    match node:
        case ast.IfExp():
            return is_truth(node.body) and is_truth(node.orelse)
        case ast.Call(func=ast.Name(id="bool")) | ast.UnaryOp(op=ast.Not()) | ast.Compare() | ast.BoolOp():
            return True
        case ast.BinOp(op=ast.BitAnd() | ast.BitOr() | ast.BitXor()):
            return is_truth(node.left) and is_truth(node.right)
    return isinstance(node, ast.Constant) and isinstance(node.value, bool)
