"""The version of the generator and of what it emits."""

VERSION = "0.1.0"
