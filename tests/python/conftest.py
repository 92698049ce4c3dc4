"""Settings and data of all tests of the package."""

from __future__ import annotations

import os
import sys

import hypothesis
import numpy as np
import pytest

# The same examples on every machine, however slow it is.
hypothesis.settings.register_profile("touchstone", derandomize=True, deadline=None, database=None)
hypothesis.settings.load_profile("touchstone")


@pytest.fixture(scope="session")
def queries() -> np.ndarray:
    """Random queries, of which a fifth collides."""
    return np.random.default_rng(2021).normal(size=(4000, 8, 3))


@pytest.fixture
def only_released():
    """Other threads run only while the lock of Python is released."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1000.0)
    yield
    sys.setswitchinterval(before)


@pytest.fixture(scope="session")
def tool() -> str:
    """The path of the command line tool."""
    return os.environ["TOUCHSTONE_PROGRAM"]
