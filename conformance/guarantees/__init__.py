"""What each specification guarantees of each function: the share of its domain, and the error it then has.

`python -m conformance.guarantees` surveys what changed since shaderlib/guarantees.json was written, `--all`
everything; `--check` surveys everything and fails if the file is out of date.
"""

from conformance.guarantees.survey import survey
from conformance.guarantees.table import PATH, read, stale

__all__ = ["PATH", "read", "stale", "survey"]
