"""A worker whose driver takes the process down."""

import sys

if __name__ == "__main__":
    sys.stdin.buffer.read()
    print("the driver gave up", file=sys.stderr)
    sys.exit(3)
