"""Scene files: strict TOML, typed tables, one sentence for whatever is wrong."""

from coupled.errors import SceneError
from coupled.scene.contact import Contact, Damping, Recipe
from coupled.scene.find import find_scene, shipping_scenes
from coupled.scene.grains import Box, Grains, SettledGrains, SizeClass
from coupled.scene.interface import Interface, Row, RowUnder
from coupled.scene.intruders import Intruder
from coupled.scene.load import dump_scene, load_scene
from coupled.scene.output import Output, Time
from coupled.scene.scene import Scene
from coupled.scene.schemes import Newmark
from coupled.scene.shaking import Shaking
from coupled.scene.shape import Beam, Tube
from coupled.scene.structure import (
    Initial,
    Path,
    Placement,
    Rayleigh,
    Structure,
)

__all__ = [
    "Beam",
    "Box",
    "Contact",
    "Damping",
    "Grains",
    "Initial",
    "Interface",
    "Intruder",
    "Newmark",
    "Output",
    "Path",
    "Placement",
    "Rayleigh",
    "Recipe",
    "Row",
    "RowUnder",
    "Scene",
    "SceneError",
    "SettledGrains",
    "Shaking",
    "SizeClass",
    "Structure",
    "Time",
    "Tube",
    "dump_scene",
    "find_scene",
    "load_scene",
    "shipping_scenes",
]
