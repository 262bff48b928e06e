"""./dev demo: emit the library, check it on this machine's drivers, render a bunny with each."""

import importlib
import sys

if __name__ == "__main__":
    sys.exit(importlib.import_module("conformance.picture.demo").main())
