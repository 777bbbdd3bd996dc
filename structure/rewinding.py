"""Going back to a moment of the same structure: nothing is gathered, nothing is sent."""

from __future__ import annotations

from typing import Any, ClassVar

Snapshot = dict[str, Any]


class Rewinding:
    """Keeps what a step replaces, by reference.

    `REPLACED` names the attributes that a step gives new values to and never writes into.
    """

    REPLACED: ClassVar[tuple[str, ...]]

    def snapshot(self) -> Snapshot:
        """This rank's share of the present state, for `rewind` of the same object."""
        return {name: getattr(self, name) for name in self.REPLACED}

    def rewind(self, snapshot: Snapshot) -> None:
        """Go back to a `snapshot`: the steps that follow have the same bits."""
        for name in self.REPLACED:
            setattr(self, name, snapshot[name])
