"""Rules between the tables of a scene. Plain arithmetic: nothing heavy is imported here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coupled.scene.rules.contact import check_contact
from coupled.scene.rules.grains import check_grains
from coupled.scene.rules.interface import check_interface, check_rows
from coupled.scene.rules.intruders import check_intruder_sizes, check_intruders, check_periodic
from coupled.scene.rules.quantities import check_quantities
from coupled.scene.rules.shaking import check_shaking
from coupled.scene.rules.stability import check_step
from coupled.scene.rules.structure import check_structure
from coupled.scene.rules.whole import check_output, check_whole

if TYPE_CHECKING:
    from coupled.scene.scene import Scene


def check_rules(scene: Scene) -> None:
    """Refuse combinations of tables that make no sense together.

    Raises
    ------
    SceneError
        At the first rule that is broken.
    """
    check_whole(scene)
    check_intruder_sizes(scene)
    check_grains(scene)
    check_periodic(scene)
    check_intruders(scene)
    check_shaking(scene)
    check_contact(scene)
    check_structure(scene)
    check_interface(scene)
    check_rows(scene)
    check_step(scene)
    check_output(scene)
    check_quantities(scene)
