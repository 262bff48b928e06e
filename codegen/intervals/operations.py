"""Operations of the registry by name, over interval values."""

from __future__ import annotations

from collections.abc import Callable

from codegen.intervals import arithmetic, elementary, geometry, logic, whole
from codegen.intervals.context import Context
from codegen.intervals.values import Range, Single, Truth, Whole, all_of, any_of, opposite

COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")


def unary(context: Context, op: str, a: Single) -> Single:
    """`negate`, `~` or `not`."""
    if isinstance(a, Truth):
        return opposite(a)
    if isinstance(a, Whole):
        return whole.inverted(a) if op == "~" else whole.negated(a)
    return arithmetic.negate(a)


def binary(context: Context, op: str, a: Single, b: Single) -> Single:
    """An operator on two scalars."""
    if op in _FLOATS and isinstance(a, Range):
        return _FLOATS[op](context, a, b)
    if isinstance(a, Truth):
        assert isinstance(b, Truth)
        return all_of(a, b) if op == "and" else any_of(a, b)
    assert not isinstance(b, Truth)
    if op in COMPARISONS:
        return logic.compare(context, op, a, b)
    assert isinstance(a, Whole) and isinstance(b, Whole)
    return whole.binary(op, a, b)


def scalar_builtin(context: Context, op: str, *args: Single) -> Single:
    """A built-in that works component by component."""
    if isinstance(args[0], Whole):
        return _whole_builtin(context, op, args)
    if op not in _FLOATS:
        raise NotImplementedError(f"no interval form of {op}")
    return _FLOATS[op](context, *args)


_FLOATS: dict[str, Callable[..., Single]] = {
    "+": arithmetic.add,
    "-": arithmetic.subtract,
    "*": arithmetic.multiply,
    "/": lambda context, a, b: arithmetic.divide(context, context.table.row("/"), a, b),
    "abs": lambda context, x: arithmetic.absolute(x),
    "floor": logic.floor,
    "sqrt": elementary.square_root,
    "inverse_sqrt": elementary.inverse_square_root,
    "min": lambda context, a, b: arithmetic.smaller(a, b),
    "max": lambda context, a, b: arithmetic.larger(a, b),
    "clamp": lambda context, x, least, most: arithmetic.clamp(x, least, most),
    "atan2": elementary.arc_tangent,
    "exp": lambda context, x: elementary.exponential(context, "exp", x),
    "exp2": lambda context, x: elementary.exponential(context, "exp2", x),
    "log": lambda context, x: elementary.logarithm(context, "log", x),
    "log2": lambda context, x: elementary.logarithm(context, "log2", x),
    "sin": lambda context, x: elementary.sine(context, "sin", x),
    "cos": lambda context, x: elementary.sine(context, "cos", x),
    "float_to_bits": lambda context, x: whole.float_to_bits(x),
}
"""Operations on floats alone that give numbers."""


def _whole_builtin(context: Context, op: str, args: tuple[Single, ...]) -> Single:
    wholes = tuple(a for a in args if isinstance(a, Whole))
    match op:
        case "bits_to_float":
            return logic.from_bits(context, wholes[0])
        case "min":
            return whole.smaller(wholes[0], wholes[1])
        case "max":
            return whole.larger(wholes[0], wholes[1])
        case "clamp":
            return whole.smaller(whole.larger(wholes[0], wholes[1]), wholes[2])
        case _:
            raise NotImplementedError(f"no interval form of {op} on integers")


VECTOR_BUILTINS: dict[str, Callable[..., Range | tuple[Range, ...]]] = {
    "dot": geometry.dot,
    "cross": geometry.cross,
    "length": geometry.length,
    "normalize": geometry.normalize,
}
"""Built-ins that need whole vectors."""
