"""References of the library's section sampling.

Integer sequences are exact: unbounded Python integers or uint64 masked to 32 bits. Their results are float32
values, returned as float64; unsigned words stay uint32. Pairs have shape (N, 2).
"""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from conformance.reference.ambiguous import Inputs
from conformance.reference.exact import Array, Mask, Reference, Words, real, stack

BIT_EXACT: tuple[str, ...] = (
    "radical_inverse_base2", "unit_float", "hammersley", "r2_sequence", "pcg_hash", "pcg3d",
    "cranley_patterson",
)  # fmt: skip
"""Functions whose result every target must give bit for bit (cranley_patterson: for inputs k 2^-24)."""

GRID = 2.0**-24
WORD = np.uint64(0xFFFFFFFF)
REVERSED_HALVES = np.array([int(f"{half:016b}"[::-1], 2) for half in range(1 << 16)], np.uint32)
"""Numbers of 16 binary digits with these in reverse order."""
R2_FIRST, R2_SECOND = 3242174889, 2447445413
"""2^32 / g and 2^32 / g^2 for the plastic number g, rounded to odd integers."""


def _wide(x: npt.ArrayLike) -> npt.NDArray[np.uint64]:
    """Unsigned words widened so that sums and products keep every bit."""
    return np.asarray(x, dtype=np.uint64)


def _times(x: npt.NDArray[np.uint64], factor: int | npt.NDArray[np.uint64]) -> npt.NDArray[np.uint64]:
    """Product modulo 2^32; both factors are below 2^32, so 64 bits hold it."""
    return np.asarray(
        (x * np.uint64(factor) if isinstance(factor, int) else x * factor) & WORD, dtype=np.uint64
    )


def radical_inverse_base2(i: Words) -> Words:
    """The 32 binary digits of i in reverse order."""
    x = np.asarray(i, dtype=np.uint32)
    half = np.uint32(16)
    return np.asarray((REVERSED_HALVES[x & np.uint32(0xFFFF)] << half) | REVERSED_HALVES[x >> half])


def unit_float(bits: Words) -> Array:
    """The upper 24 bits as a fraction: always below 1."""
    return (_wide(bits) // np.uint64(256)).astype(np.float64) * GRID


def hammersley(i: Words, n: Words) -> Array:
    """(floor(i 2^24 / n) 2^-24, unit_float(radical inverse of i)) for i < n <= 2^20."""
    quotient = (_wide(i) << np.uint64(24)) // np.maximum(_wide(n), np.uint64(1))
    return stack(quotient.astype(np.float64) * GRID, unit_float(radical_inverse_base2(i)))


def r2_sequence(i: Words) -> Array:
    """Roberts' R2 sequence in 32-bit fixed point."""
    x = _wide(i)
    words = (_times(x, R2_FIRST).astype(np.uint32), _times(x, R2_SECOND).astype(np.uint32))
    return stack(unit_float(words[0]), unit_float(words[1]))


def pcg_hash(x: Words) -> Words:
    """One step of a 32-bit linear congruence, then the RXS-M-XS permutation (O'Neill 2014)."""
    state = (_times(_wide(x), 747796405) + np.uint64(2891336453)) & WORD
    shift = (state >> np.uint64(28)) + np.uint64(4)
    word = _times((state >> shift) ^ state, 277803737)
    return np.asarray((word >> np.uint64(22)) ^ word, dtype=np.uint64).astype(np.uint32)


def pcg3d(x: Words) -> Words:
    """Three words to three words (Jarzynski and Olano 2020)."""
    a, b, c = (
        (_times(_wide(np.asarray(x)[..., k]), 1664525) + np.uint64(1013904223)) & WORD for k in range(3)
    )

    def mix(
        a: npt.NDArray[np.uint64], b: npt.NDArray[np.uint64], c: npt.NDArray[np.uint64]
    ) -> tuple[npt.NDArray[np.uint64], npt.NDArray[np.uint64], npt.NDArray[np.uint64]]:
        a = (a + _times(b, c)) & WORD
        b = (b + _times(c, a)) & WORD
        return a, b, (c + _times(a, b)) & WORD

    a, b, c = mix(a, b, c)
    a, b, c = (w ^ (w >> np.uint64(16)) for w in (a, b, c))
    return np.stack(mix(a, b, c), axis=-1).astype(np.uint32)


def cranley_patterson(u: Array, shift: Array) -> Array:
    """Toroidal shift of a pair: (u + shift) modulo 1."""
    total = real(u) + real(shift)
    return np.where(total >= 1.0, total - 1.0, total)


def disk_concentric(u: Array) -> Array:
    """Shirley and Chiu 1997: concentric squares to concentric circles."""
    a = 2.0 * real(u) - 1.0
    x, y = a[..., 0], a[..., 1]
    wide = np.abs(x) > np.abs(y)
    radius = np.where(wide, x, y)
    safe = np.where(radius == 0.0, 1.0, radius)
    phi = np.where(wide, np.pi / 4.0 * y / safe, np.pi / 2.0 - np.pi / 4.0 * x / safe)
    return stack(radius * np.cos(phi), radius * np.sin(phi))


def hemisphere_cosine(u: Array) -> Array:
    """Malley's method: a point of the disc lifted to the hemisphere; 1 - r^2 comes from the exact radius."""
    disk = disk_concentric(u)
    inside = 2.0 * np.min(np.minimum(real(u), 1.0 - real(u)), axis=-1)  # 1 - r, exact also for tiny u
    return stack(disk[..., 0], disk[..., 1], np.sqrt(inside * (2.0 - inside)))


def sphere_uniform(u: Array) -> Array:
    """Archimedes: z uniform, azimuth uniform."""
    x, phi = real(u)[..., 0], 2.0 * np.pi * real(u)[..., 1]
    s = 2.0 * np.sqrt(x * (1.0 - x))
    return stack(s * np.cos(phi), s * np.sin(phi), 1.0 - 2.0 * x)


def wrapped_sum(inputs: Inputs) -> Mask:
    """Off the grid k 2^-24 the sum u + shift may round across the wrap at 1."""
    u, shift = real(inputs["u"]), real(inputs["shift"])
    off_grid = (np.mod(u, GRID) != 0.0) | (np.mod(shift, GRID) != 0.0)
    return np.asarray(np.any(off_grid & (np.abs(u + shift - 1.0) < 2.0 * GRID), axis=-1), dtype=np.bool_)


AMBIGUOUS: dict[str, Callable[[Inputs], Mask]] = {"cranley_patterson": wrapped_sum}

REFERENCES: dict[str, Reference] = {
    f.__name__: f
    for f in (
        radical_inverse_base2, unit_float, hammersley, r2_sequence, pcg_hash, pcg3d, cranley_patterson,
        disk_concentric, hemisphere_cosine, sphere_uniform,
    )
}  # fmt: skip
