"""Makes the helper modules of this folder importable, and lends one process to all its tests."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from leito_process import LeitoProcess


@pytest.fixture(scope="session")
def leito() -> Iterator[LeitoProcess]:
    """The command `leito` in a process of its own."""
    with LeitoProcess() as process:
        yield process
