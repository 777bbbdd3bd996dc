"""No test depends on how busy the machine is: an example of Hypothesis may take any time, processes share the cores."""

import os

from hypothesis import HealthCheck, settings

settings.register_profile("patient", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("patient")

if "PYTEST_XDIST_WORKER" in os.environ:  # threads of linear algebra that wait for each other's cores
    os.environ.setdefault("OMP_NUM_THREADS", "1")
