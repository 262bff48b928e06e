"""Long work in pieces: `run(jobs)` yields a result per job, on this machine's processes or on a cluster.

Job        pure data: a task, a function, a target, a range, a seed
Here       one after the other in this process: what the others must agree with
Processes  processes of this machine, each with its own devices
Cluster    workers of a Dask scheduler (conformance.executor.cluster, needs the package distributed)
open_executor(workers, scheduler)  the one that the options of a command line ask for
"""

from conformance.executor.jobs import Job, Result, available, perform
from conformance.executor.local import Executor, Here, Processes
from conformance.executor.options import open_executor

__all__ = ["Executor", "Here", "Job", "Processes", "Result", "available", "open_executor", "perform"]
