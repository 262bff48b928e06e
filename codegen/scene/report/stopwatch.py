"""Speed of functions beside each other on one driver: interleaved, net of loop and inputs, one process.

As `vair report` measures, in short form, because functions of a scene have parameters of their own: each lane
loads inputs once; eps times the last sum, with eps read at run time and 0, is added to every input, so that
nothing can be hoisted or shared; independent chains stand side by side. The same kernel with the sum of the
inputs in the function's place is the baseline of each. Rounds run forwards and backwards (A B B A), and the
median over the rounds counts. Software drivers are timed by the CPU time of the threads that compute,
hardware by the wall.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from codegen.backends import complete_program, dialect
from codegen.emit.module import DEFAULT_PREFIX, emit
from codegen.emit.stmt import StmtPrinter
from codegen.evaluate.arrays import Value
from codegen.execute import Words, flatten
from codegen.ir import nodes as ir
from codegen.ir.types import F32, I32, Array, Scalar, Type, Vector, leaves
from codegen.library import Library
from codegen.scene.report.speed import CHAINS, ROUNDS, Speed
from codegen.thread_times import cpu_seconds, threads

SOFTWARE = ("llvmpipe", "lavapipe", "softpipe", "swiftshader", "pocl", "portable computing", "pthread", "cpu")
LANES, FLAT_LANES = 512, 1 << 14
LAUNCH_SECONDS = 1e-2
MOST_STEPS = 1 << 14
SHARE = 0.1
"""A thread with at least this share of the process's work computes."""


def measure(
    library: Library,
    names: Sequence[str],
    runtime: Any,
    inputs: Mapping[str, Value],
    rounds: int = ROUNDS,
    *,
    texts: Mapping[str, str] | None = None,
) -> dict[str, Speed]:
    """The speeds of functions that take float inputs only, side by side.

    inputs  values for every parameter that one of them has, by name; no hard cases: a number below 2^-126
            takes a CPU a hundred times as long as others and would hide everything else
    texts   text in the target's language that defines a function, with the usual prefix, where it is not
            the emitted one
    """
    target = runtime.device.target
    looped = target != "opencl"  # a loop keeps OpenCL compilers from working on several items at once
    lanes = LANES if looped else FLAT_LANES
    programs, given, built = {}, {}, {}
    for name in names:
        f = library.function(name)
        words = _words(f, inputs, lanes)
        written = (texts or {}).get(name) or emit(library, dialect(target), [name])
        for key, text in ((name, written), (f"{name}:", "")):
            programs[key] = _kernel(f, target, looped, text)
            given[key] = words
    for name in names:
        begin = time.perf_counter()
        runtime.prepare(programs[name], _with_steps(given[name], 1), 1).release()
        built[name] = time.perf_counter() - begin
    steps = _steps(runtime, programs[names[0]], given[names[0]]) if looped else 1
    ready = {key: runtime.prepare(programs[key], _with_steps(given[key], steps), 1) for key in programs}
    try:
        clock = _working_clock(ready[names[0]]) if _is_software(runtime) else time.perf_counter
        times = _rounds(ready, clock, rounds)
    finally:
        for one in ready.values():
            one.release()
    scale = 1e9 / (2 * lanes * CHAINS * steps)
    found = {}
    for name in names:
        net = [(a - b) * scale for a, b in zip(times[name], times[f"{name}:"], strict=True)]
        low, median, high = np.quantile(net, (0.25, 0.5, 0.75))
        found[name] = Speed(float(median), float(low), float(high), built[name])
    return found


def _is_software(runtime: Any) -> bool:
    device = runtime.device
    text = f"{device.api} {device.driver} {device.device}".lower()
    return any(word in text for word in SOFTWARE)


def _rounds(ready: Mapping[str, Any], clock: Callable[[], float], rounds: int) -> dict[str, list[float]]:
    times: dict[str, list[float]] = {key: [] for key in ready}
    for one in ready.values():
        one.launch()
        one.launch()
    order = list(ready)
    for _ in range(rounds):
        sums = dict.fromkeys(order, 0.0)
        for key in (*order, *reversed(order)):
            begin = clock()
            ready[key].launch()
            sums[key] += clock() - begin
        for key, total in sums.items():
            times[key].append(total)
        order.append(order.pop(0))
    return times


def _working_clock(one: Any) -> Callable[[], float]:
    """CPU time of the threads that compute; that of the process where the system does not tell them apart.

    Threads that wait, whose share changes with whatever else the machine does, do not count.
    """
    one.launch()
    before, whole = {t: cpu_seconds(t) for t in threads()}, time.process_time()
    for _ in range(3):
        one.launch()
    whole = time.process_time() - whole
    computing = before.keys() - {threading.main_thread().native_id}
    spent = {t: cpu_seconds(t) - before[t] for t in computing}
    working = [t for t, seconds in spent.items() if seconds >= SHARE * whole]
    if not working:
        return time.process_time
    return lambda: sum(map(cpu_seconds, working))


def _steps(runtime: Any, text: str, words: Words) -> int:
    steps, clock = 1, time.process_time
    while steps < MOST_STEPS:
        ready = runtime.prepare(text, _with_steps(words, steps), 1)
        ready.launch()
        begin = clock()
        ready.launch()
        taken = clock() - begin
        ready.release()
        if taken >= LAUNCH_SECONDS:
            break
        steps *= 4
    return steps


def _words(f: ir.Function, inputs: Mapping[str, Value], lanes: int) -> Words:
    parts: list[Value] = []
    for p in f.parameters:
        value = inputs[p.name]
        assert not isinstance(value, dict)
        repeats = -(-lanes // len(value))
        rows = np.tile(value, (repeats, *[1] * (value.ndim - 1)))[:lanes]
        parts.append({str(k): rows[:, k] for k in range(p.type.size)} if isinstance(p.type, Array) else rows)
    return flatten(parts, lanes)


def _with_steps(words: Words, steps: int) -> Words:
    controls = np.zeros((2, words.shape[1]), np.uint32)
    controls[1] = steps
    return np.concatenate([words, controls])


def _kernel(f: ir.Function, target: str, looped: bool, text: str) -> str:
    """The program around a function's text; without text, the sum of the inputs in the call's place."""
    chosen = dialect(target)
    printer = StmtPrinter(chosen)
    scalars = [s for p in f.parameters for _, s in leaves(p.type)]
    start: list[ir.Stmt] = [ir.Let(f"word_{k}", _load(s, k)) for k, s in enumerate(scalars)]
    start += [ir.Let("epsilon", _load(F32, len(scalars))), ir.Let("step_count", _load(I32, len(scalars) + 1))]
    sums = [f"sum_{c}" for c in range(CHAINS)]
    start += [ir.Let(s, ir.Const(F32, 0.125 * c), mutable=True) for c, s in enumerate(sums)]
    step: list[ir.Stmt] = []
    for c, name in enumerate(sums):
        step += _evaluation(f, c, name, bool(text))
    lines = printer.block(tuple(start), "    ")
    if looped:
        counter = "var step_index" if chosen.declaration == "name: type" else "int step_index"
        lines.append(f"    for ({counter} = 0; step_index < step_count; step_index++) {{")
        lines += [*printer.block(tuple(step), "        "), "    }"]
    else:
        lines += printer.block(tuple(step), "    ")
    total = _sum([ir.Var(F32, s) for s in sums])
    lines.append(f"    store_f32(0, {printer.expr.show(total)});")
    return complete_program(target, text, "\n".join(lines))


def _evaluation(f: ir.Function, chain: int, state: str, call: bool) -> Iterator[ir.Stmt]:
    moved: list[ir.Expr] = []
    delta = ir.Var(F32, f"delta_{chain}")
    yield ir.Let(delta.name, ir.Binary(F32, "*", ir.Var(F32, "epsilon"), ir.Var(F32, state)))
    for k, scalar in enumerate(s for p in f.parameters for _, s in leaves(p.type)):
        moved.append(ir.Binary(F32, "+", ir.Var(scalar, f"word_{k}"), delta))
    if not call:
        yield ir.Assign(state, _sum(moved))
        return
    supply = iter(moved)
    arguments: list[ir.Expr] = []
    for p in f.parameters:
        value = _built(p.type, supply)
        if isinstance(p.type, Array):  # OpenCL takes arrays by name only
            yield ir.Let(f"{p.name}_{chain}", value)
            value = ir.Var(p.type, f"{p.name}_{chain}")
        arguments.append(value)
    result = ir.Var(f.returns, f"value_{chain}")
    yield ir.Let(result.name, ir.Call(f.returns, DEFAULT_PREFIX + f.name, tuple(arguments)))
    assert isinstance(f.returns, Vector)
    yield ir.Assign(state, _sum([ir.Swizzle(F32, result, c) for c in "xyzw"[: f.returns.size]]))


def _built(type_: Type, supply: Iterator[ir.Expr]) -> ir.Expr:
    if isinstance(type_, Scalar):
        return next(supply)
    if isinstance(type_, Array):
        return ir.Construct(type_, tuple(_built(type_.element, supply) for _ in range(type_.size)))
    assert isinstance(type_, Vector)
    return ir.Construct(type_, tuple(next(supply) for _ in range(type_.size)))


def _load(scalar: Scalar, slot: int) -> ir.Expr:
    return ir.Call(scalar, f"load_{scalar.name}", (ir.Const(I32, slot),))


def _sum(parts: Sequence[ir.Expr]) -> ir.Expr:
    total = parts[0]
    for part in parts[1:]:
        total = ir.Binary(F32, "+", total, part)
    return total
