"""The exchange over one step of the structure: iterated solution, its limits, and what passed the interface."""
