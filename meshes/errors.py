"""The exception of the room."""


class MeshError(ValueError):
    """A shape or a mesh that cannot be built from the given numbers."""
