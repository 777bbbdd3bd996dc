"""Number types of the scene file and the base class of its tables.

TOML already tells numbers from strings, so a string is never read as a number here.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Strict, model_validator
from pydantic_core import PydanticCustomError

LARGEST = 1e30  # products and squares of numbers stay finite, and results fit into frames of single precision

Number = Annotated[float, Strict(), Field(ge=-LARGEST, le=LARGEST)]
Positive = Annotated[float, Strict(), Field(gt=0, le=LARGEST)]
NonNegative = Annotated[float, Strict(), Field(ge=0, le=LARGEST)]
Fraction = Annotated[float, Strict(), Field(ge=0, le=1)]
Count = Annotated[int, Strict(), Field(ge=1)]
Whole = Annotated[int, Strict(), Field(ge=0)]
Flag = Annotated[bool, Strict()]
Vector = tuple[Number, Number]


class Table(BaseModel):
    """A table of the scene file: frozen, finite numbers only, no key that it does not know."""

    beside: ClassVar[str] = ""
    """What narrows the allowed keys, for the sentence of refusal."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _known_keys_only(cls, data: Any) -> Any:
        """Refuse an unknown key here, where the allowed ones are at hand for a suggestion."""
        if isinstance(data, dict):
            unknown = [key for key in data if key not in cls.model_fields]
            if unknown:
                allowed = list(cls.model_fields)
                raise PydanticCustomError(
                    "unknown_key",
                    "unknown key",
                    {"unknown": unknown[0], "allowed": allowed, "beside": cls.beside},
                )
        return data


def by_kind(*alone: str, **groups: tuple[str, ...]) -> Discriminator:
    """Choose a table by its kind, which must be one of those allowed.

    Parameters
    ----------
    alone
        Kinds with a table of their own, whose tag is ``"<kind>"``.
    groups
        Kinds that share a table, by the word in its tag.
    """
    tags = {kind: f"<{kind}>" for kind in alone}
    tags |= {kind: f"<{group}>" for group, kinds in groups.items() for kind in kinds}

    def tag(data: Any) -> str | None:
        kind = data.get("kind") if isinstance(data, dict) else getattr(data, "kind", None)
        return tags.get(kind) if isinstance(kind, str) else None

    return Discriminator(
        tag,
        custom_error_type="unknown_kind",
        custom_error_message="unknown kind",
        custom_error_context={"allowed": list(tags)},
    )
