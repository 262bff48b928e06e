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
    if isinstance(a, Truth):
        assert isinstance(b, Truth)
        return all_of(a, b) if op == "and" else any_of(a, b)
    assert not isinstance(b, Truth)
    if op in COMPARISONS:
        return logic.compare(context, op, a, b)
    if isinstance(a, Whole):
        assert isinstance(b, Whole)
        return whole.binary(op, a, b)
    assert isinstance(b, Range)
    match op:
        case "+":
            return arithmetic.add(context, a, b)
        case "-":
            return arithmetic.subtract(context, a, b)
        case "*":
            return arithmetic.multiply(context, a, b)
        case _:
            return arithmetic.divide(context, context.table.row("/"), a, b)


def scalar_builtin(context: Context, op: str, args: tuple[Single, ...]) -> Single:
    """A built-in that works component by component."""
    if isinstance(args[0], Whole):
        return _whole_builtin(context, op, args)
    floats = tuple(a for a in args if isinstance(a, Range))
    if op == "float_to_bits":
        return whole.float_to_bits(floats[0])
    if op in _ONE:
        return _ONE[op](context, floats[0])
    match op:
        case "min":
            return arithmetic.smaller(floats[0], floats[1])
        case "max":
            return arithmetic.larger(floats[0], floats[1])
        case "clamp":
            return arithmetic.clamp(floats[0], floats[1], floats[2])
        case "atan2":
            return elementary.arc_tangent(context, floats[0], floats[1])
        case "exp" | "exp2":
            return elementary.exponential(context, op, floats[0])
        case "log" | "log2":
            return elementary.logarithm(context, op, floats[0])
        case "sin" | "cos":
            return elementary.sine(context, op, floats[0])
        case _:
            raise NotImplementedError(f"no interval form of {op}")


_ONE: dict[str, Callable[[Context, Range], Single]] = {
    "abs": lambda context, x: arithmetic.absolute(x),
    "floor": logic.floor,
    "sqrt": elementary.square_root,
    "inverse_sqrt": elementary.inverse_square_root,
}


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
