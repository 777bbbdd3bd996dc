"""What acts on a structure from outside: loads, their schedules in time, and the nodal forces they give."""
