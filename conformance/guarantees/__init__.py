"""What each specification guarantees of each function: the share of its domain, and the error it then has.

`python -m conformance.guarantees` writes guarantees.json anew and lists what WGSL does not guarantee;
`--check` fails if the file is out of date.
"""

from conformance.guarantees.survey import Guarantee, survey
from conformance.guarantees.table import PATH, read

__all__ = ["PATH", "Guarantee", "read", "survey"]
