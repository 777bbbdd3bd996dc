"""Linear solvers: chosen by size, overridable by PETSc options."""
