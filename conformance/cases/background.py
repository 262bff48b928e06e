"""Values of all parameters, drawn independently: uniform, or leaning to the ends of their domains."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from conformance.cases import domains
from conformance.cases.parameters import Column, Leaf
from conformance.cases.stream import AXES, F64, Stream, single


def frames(stream: Stream, normals: F64) -> dict[str, npt.NDArray[np.float32]]:
    """Right-handed orthonormal frames about the given normals, turned at random."""
    tangent = stream.across(normals)
    bitangent = np.cross(normals, tangent)
    return {"tangent": single(tangent), "bitangent": single(bitangent), "normal": single(normals)}


def size_of(type_: str) -> int:
    """Components of vec2 ... uvec3; 1 for a scalar."""
    return int(type_[-1]) if "vec" in type_ else 1


def shaped(flat: npt.NDArray[Any], n: int, size: int) -> npt.NDArray[Any]:
    """(n,) for a scalar, (n, size) for a vector."""
    return flat if size == 1 else flat.reshape(n, size)


def uniform(stream: Stream, leaf: Leaf, n: int) -> Column:
    """n values spread over the domain as its scale says."""
    size = size_of(leaf.type)
    if leaf.type == "Frame":
        return frames(stream, stream.directions(n))
    if leaf.type == "bool":
        return stream.uniform(n) < 0.5
    if leaf.type == "i32" or leaf.type.startswith("u"):
        integers = domains.uniform_integers(stream, n * size, leaf.domain, leaf.type == "i32")
        return shaped(integers, n, size)
    if size == 1:
        return domains.uniform_f32(stream, n, leaf.domain)
    return domains.uniform_vectors(stream, n, size, leaf.domain)


def ends(stream: Stream, leaf: Leaf, n: int) -> Column:
    """n values picked from the ends of the domain."""
    size = size_of(leaf.type)
    if leaf.type == "Frame":
        return frames(stream, AXES[stream.below(n, len(AXES))])
    if leaf.type == "bool":
        return stream.uniform(n) < 0.5
    if leaf.type == "i32" or leaf.type.startswith("u"):
        pool = domains.ends_integers(leaf.domain, leaf.type == "i32")
        return shaped(pool[stream.below(n * size, len(pool))], n, size)
    whole = domains.ends_vectors(leaf.domain, size) if size > 1 else None
    if whole is not None:
        return whole[stream.below(n, len(whole))]
    numbers = domains.ends_f32(leaf.domain)
    return shaped(numbers[stream.below(n * size, len(numbers))], n, size)


def mixed(stream: Stream, leaf: Leaf, n: int, share: float) -> Column:
    """Uniform values, about `share` of them replaced by ends of the domain."""
    chosen = stream.uniform(n) < share
    free, extreme = uniform(stream, leaf, n), ends(stream, leaf, n)
    if isinstance(free, dict) and isinstance(extreme, dict):
        return {name: np.where(chosen[:, None], extreme[name], free[name]) for name in free}
    free, extreme = np.asarray(free), np.asarray(extreme)
    return np.where(chosen if free.ndim == 1 else chosen[:, None], extreme, free)


def related(values: dict[str, Any]) -> None:
    """Make values respect what the documentation says of two parameters together, beyond their domains.

    i < n (hammersley), layer < layers (shells), cos_dark <= cos_lit (f_surface; equality is a hard case).
    """
    for index, count in (("i", "n"), ("layer", "layers")):
        if is_integer(values.get(index)) and is_integer(values.get(count)):
            values[count] = np.maximum(values[count], 1)
            values[index] = np.minimum(values[index], values[index] % values[count])
    if "cos_dark" in values and "cos_lit" in values:
        dark, lit = values["cos_dark"], values["cos_lit"]
        values["cos_dark"], values["cos_lit"] = np.minimum(dark, lit), np.maximum(dark, lit)
    for value in values.values():
        if isinstance(value, dict):
            related(value)


def is_integer(values: Any) -> bool:
    """Whether these are integers (a normal n is not)."""
    return isinstance(values, np.ndarray) and values.dtype.kind == "u"
