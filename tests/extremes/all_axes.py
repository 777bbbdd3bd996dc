"""All axes, in the order of the page."""

import grain_laws
import grain_motion
import grain_sizes
import grain_time
import scene_numbers

AXES = (*grain_time.AXES, *grain_laws.AXES, *grain_sizes.AXES, *grain_motion.AXES, *scene_numbers.AXES)
