"""The command of tests that run it: $KERF, else the one that is installed."""

import os
import shutil

import pytest


def command():
    """The path of the command; skips the test where there is none, as after `pip install`."""
    found = shutil.which(os.environ.get("KERF", "kerf"))
    return found or pytest.skip("the command kerf is not installed, and KERF does not name it")
