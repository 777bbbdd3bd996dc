"""The command `leito`: `app.py` joins the commands, one module per group of them.

The commands import what they call inside their functions, and only there: FEniCSx and compiled
kernels take seconds to load, and `leito list` or the refusal of a bad scene must not wait for them.
"""

from coupled.cli.app import main

__all__ = ["main"]
