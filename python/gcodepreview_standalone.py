"""gcodepreview under its other name."""

from gcodepreview import *  # noqa: F401,F403
from gcodepreview import __all__  # noqa: F401
