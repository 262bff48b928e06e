"""The small kit, written once a file of tests, and what the evaluator computes of it."""

from pathlib import Path

import pytest

from conformance.unit.kit.small_kit import Data, compute, write_kit


@pytest.fixture(scope="module")
def kit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The kit's folder."""
    return write_kit(tmp_path_factory.mktemp("kit") / "kit")


@pytest.fixture(scope="module")
def computed(kit: Path) -> Data:
    """Results of the evaluator, as a runner writes them."""
    return compute(kit)
