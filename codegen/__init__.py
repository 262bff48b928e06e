"""Vair's code generator: front end -> typed IR -> passes -> emission, and the analyses of the IR."""
