"""The executor that the options of a command line ask for."""

from __future__ import annotations

from codegen.errors import UserError
from conformance.executor.local import Executor, Here, Processes


def open_executor(workers: int, scheduler: str | None) -> Executor:
    """A cluster if a scheduler is named, this process for one worker, else processes of this machine.

    errors  UserError where the package distributed or the scheduler is missing
    """
    if scheduler is not None:
        try:
            from conformance.executor.cluster import Cluster
        except ImportError as e:
            raise UserError(
                f"--scheduler needs the package distributed: pip install vair[cluster] ({e})"
            ) from e
        try:
            return Cluster(scheduler)
        except OSError as e:
            raise UserError(f"no Dask scheduler answers at {scheduler}: {e}") from e
    return Here() if workers <= 1 else Processes(workers)
