"""Bad tables of the contact law: each is refused in one sentence that names the key and the remedy."""

from __future__ import annotations

import pytest
from bad_scenes import BEAM_ON_ROW, GONE, GRAINS, HERTZ, SURFACES, Case, require_refusal

BAD: dict[str, Case] = {
    "grains without law": (GRAINS, {"contact": GONE}, "contact", ("missing", "normal_stiffness")),
    "friction without spring": (
        GRAINS,
        {"contact.tangential_stiffness": GONE},
        "contact.tangential_stiffness",
        ("friction = 0.5", "normal_stiffness/20"),
    ),
    "tangential spring without friction": (
        GRAINS,
        {"contact.friction": GONE},
        "contact.tangential_stiffness",
        ("contact.friction",),
    ),
    "rolling without friction": (
        GRAINS,
        {
            "contact.friction": GONE,
            "contact.tangential_stiffness": GONE,
            "contact.rolling_friction": 0.2,
        },
        "contact.rolling_friction",
        ("needs contact.friction",),
    ),
    "rolling damping without rolling": (
        GRAINS,
        {"contact.rolling_damping_ratio": 0.3},
        "contact.rolling_damping_ratio",
        ("rolling_friction",),
    ),
    "no stiffness": (
        GRAINS,
        {"contact.normal_stiffness": GONE},
        "contact.normal_stiffness",
        ("recipe",),
    ),
    "stiffness and recipe": (
        GRAINS,
        {
            "contact.tangential_stiffness": GONE,
            "contact.recipe": {"from_drop_height": 1.0, "restitution": 0.5},
        },
        "contact.normal_stiffness",
        ("recipe",),
    ),
    "recipe without wish": (
        GRAINS,
        {"contact": {"recipe": {"restitution": 0.5}}},
        "contact.recipe",
        ("from_drop_height", "from_impact_speed"),
    ),
    "restitution above one": (
        GRAINS,
        {"contact": {"recipe": {"from_drop_height": 1.0, "restitution": 1.5}}},
        "contact.recipe.restitution",
        ("at most 1",),
    ),
    "old name of a wish": (
        GRAINS,
        {"contact": {"recipe": {"drop_height": 1.0, "restitution": 0.5}}},
        "contact.recipe.drop_height",
        ("not a known key", "'from_drop_height'"),
    ),
    "recipe of Hertz's spring": (
        GRAINS,
        {"contact": {"normal": "hertz", "recipe": {"from_drop_height": 1.0, "restitution": 0.5}}},
        "contact.normal",
        ("linear spring",),
    ),
    "recipe without grains": (
        BEAM_ON_ROW,
        {"contact": {"recipe": {"from_impact_speed": 1.0, "restitution": 0.5}}},
        "contact.recipe",
        ("free grains", "give normal_stiffness"),
    ),
    "restitution and dashpot": (
        GRAINS,
        {"contact.restitution": 0.8, "contact.normal_damping": 10.0},
        "contact.normal_damping",
        ("contact.restitution", "keep one"),
    ),
    "no rebound": (GRAINS, {"contact.restitution": 0.0}, "contact.restitution", ("at least 1e-12",)),
    "end of no restitution": (
        GRAINS,
        {"contact.restitution_at": "zero_overlap"},
        "contact.restitution_at",
        ("needs contact.restitution",),
    ),
    "restitution of prescribed grains": (
        BEAM_ON_ROW,
        {"contact.restitution": 0.5},
        "contact.restitution",
        ("mass of a free grain", "outright"),
    ),
    "unknown spring": (GRAINS, {"contact.normal": "herz"}, "contact.normal", ("'hertz'",)),
    "modulus of a linear spring": (
        GRAINS,
        {"contact.youngs_modulus": 1e8},
        "contact.youngs_modulus",
        ('contact.normal = "hertz"',),
    ),
    "linear spring of Hertz": (
        HERTZ,
        {"contact.normal_stiffness": 1e6},
        "contact.normal_stiffness",
        ("contact.hertz_stiffness",),
    ),
    "dashpot of Hertz": (HERTZ, {"contact.normal_damping": 1.0}, "contact.normal_damping", ("contact.restitution",)),
    "Hertz's spring twice": (
        HERTZ,
        {"contact.hertz_stiffness": 1e8},
        "contact.hertz_stiffness",
        ("contact.youngs_modulus", "keep one"),
    ),
    "no spring of Hertz": (
        GRAINS,
        {"contact": {"normal": "hertz"}},
        "contact.hertz_stiffness",
        ("missing", "youngs_modulus"),
    ),
    "modulus without Poisson's ratio": (
        HERTZ,
        {"contact.poissons_ratio": GONE},
        "contact.poissons_ratio",
        ("beside youngs_modulus",),
    ),
    "grains that grow when squeezed": (
        HERTZ,
        {"contact.poissons_ratio": 0.6},
        "contact.poissons_ratio",
        ("at most 0.5",),
    ),
    "friction on Hertz's stiffness": (
        GRAINS,
        {"contact": {"normal": "hertz", "hertz_stiffness": 1e8, "friction": 0.5}},
        "contact.tangential_ratio",
        ("friction = 0.5", "youngs_modulus"),
    ),
    "two tangential springs": (
        GRAINS,
        {"contact.tangential_ratio": 0.05},
        "contact.tangential_ratio",
        ("contact.tangential_stiffness",),
    ),
    "dashpot of another tangential spring": (
        GRAINS,
        {"contact.tangential_damping_ratio": 0.1},
        "contact.tangential_damping_ratio",
        ("contact.tangential_damping",),
    ),
    "rolling spring on Mindlin's": (
        HERTZ,
        {"contact.rolling_friction": 0.1},
        "contact.rolling_stiffness",
        ("missing", "N m/rad", '"constant_torque"'),
    ),
    "rolling spring of a constant torque": (
        GRAINS,
        {"contact.rolling_friction": 0.1, "contact.rolling": "constant_torque", "contact.rolling_stiffness": 1.0},
        "contact.rolling_stiffness",
        ('"elastic_plastic"',),
    ),
    "kind of no rolling resistance": (
        GRAINS,
        {"contact.rolling": "constant_torque"},
        "contact.rolling",
        ("needs contact.rolling_friction",),
    ),
    "pair of an unknown material": (
        SURFACES,
        {"contact.pairs.0.between": ["grains", "stucture"]},
        "contact.pairs.0.between.1",
        ("no material", "'structure'", "kerb", "walls"),
    ),
    "pair with a wall that is not there": (
        SURFACES,
        {"contact.pairs.2.between": ["grains", "lid"]},
        "contact.pairs.2.between.1",
        ("no material",),
    ),
    "pair of three": (
        SURFACES,
        {"contact.pairs.0.between": ["grains", "structure", "kerb"]},
        "contact.pairs.0.between",
        ("at most 2",),
    ),
    "pair of one": (SURFACES, {"contact.pairs.0.between": ["grains"]}, "contact.pairs.0.between", ("too few",)),
    "pair twice": (
        SURFACES,
        {"contact.pairs.1.between": ["structure", "grains"]},
        "contact.pairs.1.between",
        ("given already", "keep one"),
    ),
    "pair that never meets": (
        SURFACES,
        {"contact.pairs.1.between": ["structure", "floor"]},
        "contact.pairs.1.between",
        ("never meet", "remove"),
    ),
    "pair without numbers": (SURFACES, {"contact.pairs.0.friction": GONE}, "contact.pairs.0", ("friction",)),
    "pair with a key of all": (
        SURFACES,
        {"contact.pairs.0.rolling": "constant_torque"},
        "contact.pairs.0.rolling",
        ("not a known key",),
    ),
    "pair with another dashpot": (
        SURFACES,
        {"contact.pairs.0.normal_damping": 1.0},
        "contact.pairs.0.normal_damping",
        ("another kind", "restitution"),
    ),
    "pair with another tangential spring": (
        SURFACES,
        {"contact.pairs.0.tangential_stiffness": 1e5},
        "contact.pairs.0.tangential_stiffness",
        ("another kind", "tangential_ratio"),
    ),
    "pair of half a material": (
        HERTZ,
        {
            "contact": {
                "normal": "hertz",
                "hertz_stiffness": 1e8,
                "pairs": [{"between": ["grains", "floor"], "youngs_modulus": 1e8}],
            }
        },
        "contact.pairs.0.poissons_ratio",
        ("missing", "youngs_modulus"),
    ),
    "friction of a pair without spring": (
        SURFACES,
        {"contact.friction": GONE, "contact.tangential_ratio": GONE},
        "contact.pairs.0.tangential_stiffness",
        ("friction = 0.2",),
    ),
    "row with the name of another material": (SURFACES, {"rows.0.name": "walls"}, "rows.0.name", ("taken",)),
    "constants of an unknown material": (
        HERTZ,
        {"contact.materials.flor": {"youngs_modulus": 1e9, "poissons_ratio": 0.2}},
        "contact.materials.flor",
        ("no material", "'floor'"),
    ),
    "constants of half a material": (
        HERTZ,
        {"contact.materials.floor.poissons_ratio": GONE},
        "contact.materials.floor.poissons_ratio",
        ("missing", "[contact.materials.floor]"),
    ),
    "constants of a linear spring": (
        SURFACES,
        {"contact.materials": {"floor": {"youngs_modulus": 1e9, "poissons_ratio": 0.2}}},
        "contact.materials",
        ('contact.normal = "hertz"',),
    ),
    "constants of some": (
        HERTZ,
        {"contact.youngs_modulus": GONE, "contact.poissons_ratio": GONE},
        "contact.materials.grains",
        ("missing", "youngs_modulus"),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_contact_is_refused_in_one_sentence(case, tmp_path):
    require_refusal(BAD[case], tmp_path)
