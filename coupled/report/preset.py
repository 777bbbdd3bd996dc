"""What a preset did to a scene, in words."""

from __future__ import annotations

from coupled.scene import Scene

Row = tuple[str, str, str]
AS_IT_IS = "nothing, the scene as it is"


def preset_rows(scene: Scene) -> list[Row]:
    """Rows (section, quantity, value): the preset, the keys it has set and those that were written by hand."""
    if scene.preset is None:
        return []
    rows = [
        ("accuracy", "preset", scene.preset.name),
        ("accuracy", "sets", ", ".join(scene.preset.gives) or AS_IT_IS),
    ]
    if scene.preset.by_hand:
        rows.append(("accuracy", "by hand", ", ".join(scene.preset.by_hand)))
    return rows


def preset_sentences(scene: Scene) -> list[str]:
    """The same as one sentence, none without a preset."""
    if scene.preset is None:
        return []
    by_hand = f"; by hand: {', '.join(scene.preset.by_hand)}" if scene.preset.by_hand else ""
    return [f"accuracy {scene.preset.name}: {', '.join(scene.preset.gives) or AS_IT_IS}{by_hand}"]
