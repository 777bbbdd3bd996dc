"""All axes, in the order of the page."""

import grain_laws
import grain_time

AXES = (*grain_time.AXES, *grain_laws.AXES)
