"""Measures of granular states and records: arrays in, arrays out, no files."""

from particles.measures.cells import Cells
from particles.measures.convection import Convection, convection
from particles.measures.large_deviation import (
    Cumulants,
    Extrapolated,
    RateFunction,
    cumulants,
    extrapolated,
    rate_function,
    usual_edges,
)
from particles.measures.moments import Estimate, WindowMoments, window_moments
from particles.measures.packing import area_below, area_in_quadrant, fraction_in_cells, fraction_in_strips
from particles.measures.profiles import Profile, coordination_in_strips, mean_in_strips
from particles.measures.resampling import Resampling, checked_sequences
from particles.measures.strobe import Portrait, Strobe, portrait, quietest_phase, strobe
from particles.measures.symmetry import Symmetry, SymmetryPoints, limit_of_slope, symmetry
from particles.measures.temperature import MovingGrains, Temperature, granular_temperature

__all__ = [
    "Cells",
    "Convection",
    "Cumulants",
    "Estimate",
    "Extrapolated",
    "MovingGrains",
    "Portrait",
    "Profile",
    "RateFunction",
    "Resampling",
    "Strobe",
    "Symmetry",
    "SymmetryPoints",
    "Temperature",
    "WindowMoments",
    "area_below",
    "area_in_quadrant",
    "checked_sequences",
    "convection",
    "coordination_in_strips",
    "cumulants",
    "extrapolated",
    "fraction_in_cells",
    "fraction_in_strips",
    "granular_temperature",
    "limit_of_slope",
    "mean_in_strips",
    "portrait",
    "quietest_phase",
    "rate_function",
    "strobe",
    "symmetry",
    "usual_edges",
    "window_moments",
]
