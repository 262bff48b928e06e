"""Running the IR on arrays without a device: float32 op by op, float64, or mpmath."""

from codegen.evaluate.arrays import ARITHMETICS, Value
from codegen.evaluate.interpreter import evaluate

__all__ = ["ARITHMETICS", "Value", "evaluate"]
