"""`leito list` and `leito new`: scene files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coupled.cli.speech import print_table


def list_scenes() -> None:
    """List the scenes that ship."""
    from coupled.scene import load_scene, shipping_scenes
    from coupled.scene.units import in_units

    rows = []
    for name, path in shipping_scenes().items():
        scene = load_scene(path)
        grains = str(scene.first_grains.count) if scene.first_grains is not None else "-"
        structure = scene.structure.kind if scene.structure is not None else "-"
        rows.append((name, grains, structure, in_units(f"{scene.time.duration:g} s", scene.units), scene.title))
    print_table(("scene", "grains", "structure", "duration", "title"), rows)


def new(
    kind: Annotated[str, typer.Argument(help="tube, beam or grains.", metavar="KIND")],
    to: Annotated[Path | None, typer.Option(help="File to write; KIND.toml by default.")] = None,
) -> None:
    """Write a small commented scene to start from."""
    from coupled.templates import write_template

    path = write_template(kind, to)
    print(f"wrote {path}; run it with: leito run {path}")
