"""A kit for backends that are not shipped: inputs, expected results, texts to call, results that return."""

from pathlib import Path


def readme() -> bytes:
    """The description of a runner that goes into every kit."""
    return (Path(__file__).parent / "runner.md").read_bytes()
