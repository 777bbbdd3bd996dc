"""The exceptions of the room."""


class StructureError(ValueError):
    """A structure, a load or a motion that cannot be modelled as asked."""


class StepError(StructureError):
    """A step in time that finds no balance of forces."""
