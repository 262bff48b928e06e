"""Sweeps over every float32 (or u32) in the domain of the functions of one argument, on every target.

A sweep over all of a domain gives a *bound*: the error cannot be larger on that driver. A sweep over every
n-th float, or over a range, gives a *lower bound* of the worst error. The records in results say which.

python -m conformance.sweep          sweep; what was done before is not done again
conformance.sweep.task:run           one piece of a sweep, for the executors
conformance.sweep.task:run_together  the same piece for several targets, with one reference
"""
