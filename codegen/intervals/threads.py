"""How many chunks of lanes are evaluated at a time; results do not depend on it."""

from __future__ import annotations

import multiprocessing
import os

from codegen.errors import UserError

VARIABLE = "VAIR_INTERVAL_THREADS"
"""Environment variable with the number of threads."""
MOST = 2


def threads() -> int:
    """The number that the environment asks for; else 2 where there are processors, 1 in a worker process."""
    told = os.environ.get(VARIABLE)
    if told is None:
        return 1 if multiprocessing.parent_process() is not None else min(MOST, os.cpu_count() or 1)
    if not (told.isascii() and told.isdigit() and 0 < int(told) <= 1024):
        raise UserError(f'{VARIABLE} is "{told}"; give a number of threads from 1 to 1024')
    return int(told)
