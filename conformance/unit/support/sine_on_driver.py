"""`python -m conformance.unit.support.sine_on_driver NAME FOLDER`: sin(x) on a driver, judged.

For a process with the environment of the driver. FOLDER takes the source of one function, whose reference is
numpy's sine in float64.
"""

import json
import sys
from pathlib import Path
from unittest import mock

import numpy as np

from conformance.check import prepared
from conformance.check.draws import Draw
from conformance.check.engine import check_function
from conformance.drivers.modes import mode
from conformance.drivers.worker import driver_backend
from conformance.unit.support.sources import library_of
from targets import TargetUnavailable
from targets.drivers import driver

POINTS = 20_001
BOUNDS = '[[probe]]\nmeasure = "absolute"\nbound = 1\ndomain = "|x| <= 3"\norigin = "none is declared"\n'


def main() -> None:
    """Check the function and print the result, or why there is none."""
    name, folder = sys.argv[1], Path(sys.argv[2])
    library = library_of(folder, "def probe(x: X) -> f32:\n    return sin(x)\n")
    (folder / "numeric/bounds.toml").write_text(BOUNDS, encoding="utf-8")
    try:
        on = driver_backend(driver(name), mode("default"))
    except TargetUnavailable as reason:
        print(json.dumps({"unavailable": str(reason)}))
        return
    inputs = {"x": np.linspace(-3.0, 3.0, POINTS, dtype=np.float32)}
    with mock.patch.object(prepared, "find_reference", lambda *_: np.sin):
        result = check_function(library, "probe", on, [Draw("here", POINTS, 0, inputs)])
    print(json.dumps(result.as_data()))


if __name__ == "__main__":
    main()
