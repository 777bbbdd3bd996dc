"""The errors a user can cause; each message is one sentence that names the remedy."""

from __future__ import annotations


class LeitoError(Exception):
    """An error of the input or of its surroundings, said in one sentence."""


class SceneError(LeitoError):
    """A scene file that is refused.

    Parameters
    ----------
    sentence
        What is wrong, with the key's path, its value, what is allowed and the remedy.
    key
        Dotted path of the key, e.g. ``"grains.sizes.0.radius"``; empty for the file as a whole.
    file
        Name of the file, already said in the sentence; empty while it is not.
    """

    def __init__(self, sentence: str, *, key: str = "", file: str = "") -> None:
        super().__init__(sentence)
        self.key = key
        self.file = file


class ExchangeError(LeitoError):
    """An exchange between grains and structure that does not converge."""


class QuantityError(LeitoError):
    """A quantity of interest that a run does not have: a depth never reached, a window after its end."""


class Interrupted(LeitoError):
    """A run stopped by the user; the message says how to go on."""


# Named rather than imported: importing their rooms would load FEniCSx for every command.
_ROOM_ERRORS = {
    ("meshes", "MeshError"),
    ("structure", "StructureError"),
    ("particles", "ParticleError"),
}


def is_sentence(error: Exception) -> bool:
    """Whether an error is one sentence to the user, of this room or another, rather than a defect of ours."""
    kinds = {(kind.__module__.partition(".")[0], kind.__name__) for kind in type(error).__mro__}
    return isinstance(error, LeitoError) or bool(kinds & _ROOM_ERRORS)
