"""The exception of the room."""


class StructureError(ValueError):
    """A structure, a load or a motion that cannot be modelled as asked."""
