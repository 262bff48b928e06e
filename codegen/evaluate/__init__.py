"""Running the IR on arrays without a device: float32 or half op by op, float64, or mpmath."""

from codegen.evaluate.arrays import ARITHMETICS, HALF_ARITHMETICS, Value
from codegen.evaluate.interpreter import evaluate

__all__ = ["ARITHMETICS", "HALF_ARITHMETICS", "Value", "evaluate"]
