"""A worker whose driver takes the process down or never answers; VAIR_TEST_SIGNAL names a signal, if any."""

import os
import signal
import sys
import time

if __name__ == "__main__":
    sys.stdin.buffer.read()
    print("the driver gave up", file=sys.stderr)
    name = os.environ.get("VAIR_TEST_SIGNAL", "")
    if name == "none":
        time.sleep(60.0)
    if name:
        os.kill(os.getpid(), signal.Signals[name])
    sys.exit(3)
