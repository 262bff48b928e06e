"""What a function costs on a target: as recorded on its driver, else a sum over its operations.

Prices only decide what is tried first; what a scene gains is measured.
"""

from __future__ import annotations

import functools
import statistics
from collections import Counter
from dataclasses import dataclass, field

from codegen.costs import entry, recorded
from codegen.errors import UserError
from codegen.ir import nodes as ir
from codegen.ir.types import Vector
from codegen.library import Library
from codegen.ops import BUILTINS, OPERATORS

DRIVERS = {"glsl": "llvmpipe", "wgsl": "lavapipe", "opencl": "pocl"}
MODES = {"glsl": "throughput", "wgsl": "throughput", "opencl": "flat"}
"""The mode nearest to a shader: independent evaluations; in OpenCL those of a kernel without a loop."""

WEIGHTS = {"free": 0.0, "add": 1.0, "multiply": 1.0, "divide": 4.0, "root": 5.0, "exponential": 14.0}
"""Prices of cost classes in multiplications, from the recorded core functions; others: OTHER."""
OTHER = 25.0
DEAR = {"opencl": {"exp2": 60.0, "log2": 60.0, "log": 90.0}}
"""Built-ins that keep a target's compiler from working on several lanes at once, in multiplications."""


@dataclass
class Prices:
    """Prices of one target in nanoseconds where a recording tells the scale, else in multiplications."""

    library: Library
    target: str
    source: str = "operation counts"
    scale: float = 1.0
    unit: str = "multiplications"
    _known: dict[str, float] = field(default_factory=dict)
    _weights: dict[str, float] = field(default_factory=dict)

    @staticmethod
    def of(library: Library, target: str) -> Prices:
        """The prices of a target: of the recording of its default driver, where there is one."""
        prices = Prices(library, target)
        try:
            results = recorded()
        except UserError:  # recorded by another version: a price is a hint, and counting will do
            prices.source = "operation counts; the recorded speeds are of another version"
            results = ()
        for result in results:
            device = result["device"]
            if device["target"] == target and device["short"].lower() == DRIVERS[target]:
                prices._read(result)
        return prices

    def _read(self, result: dict[str, object]) -> None:
        device = result["device"]
        assert isinstance(device, dict)
        names = set(self.library.resolver.function_names())
        functions = result["functions"]
        assert isinstance(functions, list)
        for f in functions:
            data = entry(result, f["name"])
            speed = data["speed"].get(MODES[self.target]) if data else None
            if speed and speed["net_ns"] > 0.0 and f["name"] in names:
                self._known[f["name"]] = float(speed["net_ns"])
        weighed = [(ns, _recorded_weight(f)) for f in functions if (ns := self._known.get(f["name"]))]
        ratios = [ns / weight for ns, weight in weighed if weight > 0.0]
        if ratios:
            self.scale = statistics.median(ratios)
            self.unit = "ns"
            self.source = f"recorded on {device['short']}"

    def measured(self, name: str) -> bool:
        """Whether a function's speed is recorded."""
        return name in self._known

    def saving(self, old: str, new: str) -> float:
        """What calling `new` instead of `old` saves; negative where it costs."""
        if self.measured(old) and self.measured(new):
            return self._known[old] - self._known[new]
        return self.scale * (self.weight(old) - self.weight(new))

    def price(self, name: str) -> float:
        """The price of one call."""
        return self._known.get(name, self.scale * self.weight(name))

    def weight(self, name: str) -> float:
        """The operations of a function with all it calls, in multiplications."""
        if name not in self._weights:
            self._weights[name] = self.body(self.library.function(name))
        return self._weights[name]

    def body(self, f: ir.Function) -> float:
        """The same for a function that need not be in the library."""
        return _block(f.body, self.target, self.weight)


def _block(body: tuple[ir.Stmt, ...], target: str, of_call: object) -> float:
    total = 0.0
    for s in body:
        if isinstance(s, ir.For):
            total += max(s.stop - s.start, 0) * _block(s.body, target, of_call)
        elif isinstance(s, ir.If):
            total += _tree(s.condition, target, of_call)
            total += _block(s.then, target, of_call) + _block(s.orelse, target, of_call)
        else:
            total += _tree(s.value, target, of_call)
    return total


def _tree(root: ir.Expr, target: str, of_call: object) -> float:
    assert callable(of_call)
    total = 0.0
    for e in ir.walk(root):
        if isinstance(e, ir.Call):
            total += of_call(e.function)
        elif isinstance(e, ir.Unary | ir.Binary | ir.Builtin):
            size = max(
                t.size if isinstance(t, Vector) else 1 for t in (e.type, *(c.type for c in ir.children(e)))
            )
            row = BUILTINS[e.op] if isinstance(e, ir.Builtin) else OPERATORS[e.op]
            dear = DEAR.get(target, {}).get(e.op)
            total += sum(n * (dear or WEIGHTS.get(cost, OTHER)) for cost, n in row.operations(size).items())
        elif isinstance(e, ir.Select):
            total += e.type.size if isinstance(e.type, Vector) else 1
    return total


@functools.cache
def _class_weight(cost: str) -> float:
    return WEIGHTS.get(cost, OTHER)


def _recorded_weight(f: dict[str, object]) -> float:
    counts = f["operations"]
    assert isinstance(counts, dict)
    return sum(n * _class_weight(cost) for cost, n in Counter(counts).items())
