"""The op registry: every operator and built-in, one row each."""

from codegen.ops.op import Op
from codegen.ops.registry import BUILTINS, OPERATORS

__all__ = ["BUILTINS", "OPERATORS", "Op"]
