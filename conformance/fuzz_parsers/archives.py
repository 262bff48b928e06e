"""Trees of dicts, lists and scalars as npz files: arrays by name."""

from __future__ import annotations

import io
import json
import zipfile
from typing import Any

import numpy as np
import numpy.typing as npt

LARGEST = 4096
"""Elements of an array."""
DTYPES = ("float32", "float64", "float16", "uint32", "int64", "bool", "<U3", "complex64", "datetime64[s]")


def as_npz(tree: Any) -> bytes:
    """A file with an array for each key.

    An entry {"dtype", "shape", "values"} gives that array, its values repeated; a text gives itself; whatever
    else, and what numpy refuses, its JSON as a text.
    """
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, entry in tree.items() if isinstance(tree, dict) else [("value", tree)]:
            inner = io.BytesIO()
            np.lib.format.write_array(inner, array_of(entry), allow_pickle=False)
            written = name.encode("utf-8", "replace").decode().replace("\0", "?") or "?"
            archive.writestr(zipfile.ZipInfo(f"{written}.npy"[:60000]), inner.getvalue())
    return out.getvalue()


def array_of(entry: Any) -> npt.NDArray[Any]:
    """The array that an entry stands for."""
    if isinstance(entry, str):
        return np.array(entry)
    try:
        shape = tuple(int(n) for n in entry["shape"])
        if min(shape, default=1) < 0 or np.prod(shape, dtype=object) > LARGEST:
            raise ValueError("a shape of another size")
        dtype = entry["dtype"] if entry["dtype"] in DTYPES else DTYPES[len(str(entry["dtype"])) % len(DTYPES)]
        with np.errstate(all="ignore"):
            return np.resize(np.array(entry["values"], dtype), shape)
    except (ValueError, TypeError, KeyError, OverflowError):
        return np.array(json.dumps(entry))
