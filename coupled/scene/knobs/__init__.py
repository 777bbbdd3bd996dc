"""Keys that are factors on other numbers of a scene, and the scene with those numbers in their place."""

from coupled.scene.knobs.plain import plain

__all__ = ["plain"]
