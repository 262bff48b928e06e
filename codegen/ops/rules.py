"""Type rules as finite tables of overloads: argument types -> result type."""

from __future__ import annotations

from codegen.ir.types import BOOL, F32, I32, U32, UVEC2, UVEC3, VEC2, VEC3, VEC4, Scalar, Type, Vector

Overload = tuple[tuple[Type, ...], Type]
Rule = tuple[Overload, ...]

FLOATS: tuple[Scalar | Vector, ...] = (F32, VEC2, VEC3, VEC4)
FLOAT_VECTORS: tuple[Vector, ...] = (VEC2, VEC3, VEC4)
INTS: tuple[Scalar, ...] = (I32, U32)
UINTS: tuple[Scalar | Vector, ...] = (U32, UVEC2, UVEC3)


def same(types: tuple[Type, ...], arity: int) -> Rule:
    """`arity` operands of one type give that type."""
    return tuple(((t,) * arity, t) for t in types)


def arithmetic() -> Rule:
    """Floats and integers with themselves."""
    return same((*FLOATS, *INTS, UVEC2, UVEC3), 2)


def scaling() -> Rule:
    """A vector with a scalar of its element type, either way round."""
    vectors = (*FLOAT_VECTORS, UVEC2, UVEC3)
    return (
        *(((v, v.element), v) for v in vectors),
        *(((v.element, v), v) for v in vectors),
    )


def division() -> Rule:
    """Floats with themselves, and a vector by a scalar."""
    return (*same(FLOATS, 2), *(((v, F32), v) for v in FLOAT_VECTORS))


def comparison(types: tuple[Type, ...]) -> Rule:
    """Two scalars of one type give a truth value."""
    return tuple(((t, t), BOOL) for t in types)


def reduction(arity: int, types: tuple[Vector, ...] = FLOAT_VECTORS) -> Rule:
    """Vectors of one type give a scalar."""
    return tuple(((v,) * arity, F32) for v in types)


def one(arguments: tuple[Type, ...], result: Type) -> Rule:
    """A single overload."""
    return ((arguments, result),)
