"""A worker whose driver takes the process down."""

import os
import signal
import sys

if __name__ == "__main__":
    sys.stdin.buffer.read()
    print("the driver gave up", file=sys.stderr)
    if "VAIR_TEST_SIGNAL" in os.environ:
        os.kill(os.getpid(), signal.SIGTERM)
    sys.exit(3)
