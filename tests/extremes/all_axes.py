"""All axes, in the order of the page."""

import body_material
import body_motion
import coupled_axes
import grain_laws
import grain_motion
import grain_sizes
import grain_time
import scene_numbers

AXES = (
    *grain_time.AXES,
    *grain_laws.AXES,
    *grain_sizes.AXES,
    *grain_motion.AXES,
    *scene_numbers.AXES,
    *body_material.AXES,
    *body_motion.AXES,
    *coupled_axes.AXES,
)
