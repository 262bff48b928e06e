"""`python -m targets.identify DRIVER`: open a driver and print one line of JSON that says what answered.

The process must have been started with the driver's environment.
"""

import json
import sys
from dataclasses import asdict

from targets import TargetUnavailable
from targets.drivers import driver, open_driver


def main() -> None:
    """Print {"device": {...}} or {"unavailable": "why"}."""
    try:
        answer = {"device": asdict(open_driver(driver(sys.argv[1])).device)}
    except TargetUnavailable as reason:
        answer = {"unavailable": str(reason)}  # type: ignore[dict-item]  # one of two shapes
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
