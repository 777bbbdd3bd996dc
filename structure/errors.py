"""The exceptions of the room."""


class StructureError(ValueError):
    """A structure, a load or a motion that cannot be modelled as asked."""


class StepError(StructureError):
    """A step in time that finds no balance of forces, or that turns the body too far.

    Attributes
    ----------
    largest_step : float
        Largest step that would not, over the one taken, where that is known to be smaller.
    """

    def __init__(self, what: str, largest_step: float = 1.0) -> None:
        super().__init__(what)
        self.largest_step = largest_step
