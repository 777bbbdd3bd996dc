"""What is drawn with: matplotlib without a screen. To be imported from here, so that this comes first."""

from __future__ import annotations

import warnings

import matplotlib

matplotlib.use("Agg")
# Debian's own matplotlib stands beside ours; nothing here has three axes.
warnings.filterwarnings("ignore", message="Unable to import Axes3D")

from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.collections import EllipseCollection, PolyCollection  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import NullFormatter  # noqa: E402

__all__ = [
    "AbstractMovieWriter",
    "Axes",
    "EllipseCollection",
    "FFMpegWriter",
    "Figure",
    "Line2D",
    "NullFormatter",
    "PillowWriter",
    "PolyCollection",
    "plt",
]
