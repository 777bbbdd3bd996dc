"""Many runs side by side: what is to be run, what came of it, and the processes or ranks that do it."""

from coupled.campaign.campaign import run_all
from coupled.campaign.task import Outcome, Task

__all__ = ["Outcome", "Task", "run_all"]
