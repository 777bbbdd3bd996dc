"""The knobs of a study on the scenes that ship: each one changes what it says, and nothing else."""

from __future__ import annotations

import pytest

from coupled.errors import LeitoError
from coupled.limits_before import coupling_limit_of
from coupled.scene import load_scene
from coupled.scene.find import shipping_scenes
from coupled.step import with_step
from coupled.study.settings.coupling import borne
from coupled.study.settings.knobs import BY_NAME, knobs_of, values_of
from coupled.study.settings.plan import Terms, Trial, make_plan, one_turn
from coupled.study.settings.seeds import seed_key, seeds_of

STRUCTURES = ("mesh", "order", "element", "body", "exchange", "substeps", "interface", "glued")
TERMS = Terms(trial=Trial(10.0, 0.7, 0.2), samples=1, workers=1)


def reader(name, *overrides):
    return lambda changes=(), accuracy=None: load_scene(name, (*overrides, *changes))


@pytest.mark.parametrize("name", sorted(shipping_scenes()))
def test_every_value_of_every_knob_makes_another_scene_or_is_refused_in_a_sentence(name):
    base = load_scene(name)
    refused = 0
    for knob in knobs_of(base):
        if knob.name == "fraction" or knob.threads:
            continue  # the sample of a settled bed takes a second, and threads are no key
        for value in values_of(knob, base, {}):
            try:
                assert with_step(load_scene(name, knob.turn(base, value))) != with_step(base), (knob.name, value)
            except LeitoError as error:
                refused += 1
                assert str(error).endswith(".") or ";" in str(error)
    assert refused <= 6


def test_a_scene_has_the_knobs_of_what_it_models():
    def names(scene):
        return {knob.name for knob in knobs_of(load_scene(scene))}

    assert names("beam_vibration") == {"step", "mesh", "order"}
    assert names("bed") == {
        "fraction",
        "integrator",
        "coarsening",
        "stiffness",
        "rolling",
        "precision",
        "skin",
        "threads",
    }
    assert names("elastic_tube") == names("bed") | set(STRUCTURES)
    assert names("rigid_tube") == names("bed") | {"substeps", "interface", "glued"}


def turned(name, knob, value):
    base = load_scene(name)
    return with_step(load_scene(name, BY_NAME[knob].turn(base, value)))


def test_larger_grains_and_softer_springs_take_a_longer_step_by_the_root_of_their_mass_over_their_spring():
    base = load_scene("bed")
    coarse, soft = turned("bed", "coarsening", 2.0), turned("bed", "stiffness", 0.25)
    assert coarse.time.step == pytest.approx(2.0 * base.time.step) and coarse.first_grains.count == 3751
    assert soft.time.step == pytest.approx(2.0 * base.time.step)
    assert soft.contact.normal_stiffness == pytest.approx(0.25 * base.contact.normal_stiffness)


def test_rolling_off_leaves_every_number_of_rolling_out():
    assert not turned("elastic_tube", "rolling", "off").contact.rolls
    assert turned("bed", "rolling", "constant_torque").contact.rolling == "constant_torque"


def test_a_rigid_body_keeps_mass_and_load():
    base, rigid = load_scene("elastic_tube"), turned("elastic_tube", "body", "rigid")
    assert rigid.structure.kind == "free_rigid" and rigid.structure.loads == base.structure.loads
    assert rigid.structure.density == base.structure.density


def test_the_reference_refines_step_and_mesh_and_a_level_stands_before_it():
    plan = make_plan(reader("beam_vibration"), [], {}, (), TERMS)
    by_role = {setting.role: setting for setting in plan.settings}
    fine, finest = (with_step(load_scene("beam_vibration", by_role[role].changes)) for role in ("finer", "reference"))
    base = load_scene("beam_vibration")
    assert (fine.structure.beam.along, finest.structure.beam.along) == (80, 160)
    assert finest.time.step == pytest.approx(base.time.step / 4)


def test_springs_under_facets_stay_as_many_where_the_reference_refines():
    """Three glued grains on a facet are not shared by two facets or by four, but by three."""
    plan = make_plan(reader("winkler_beam"), [], {}, (), TERMS)
    scenes = {
        setting.role: with_step(load_scene("winkler_beam", setting.changes))
        for setting in plan.settings
        if setting.role in ("finer", "reference")
    }
    assert [scenes[role].structure.beam.along for role in ("finer", "reference")] == [40, 120]
    assert scenes["reference"].interface.per_facet == 1
    assert "glued" not in {knob.name for knob in knobs_of(load_scene("winkler_beam"))}


def test_finer_cells_take_the_step_that_their_exchange_bears():
    load = reader("elastic_tube")
    setting = one_turn(load, BY_NAME["mesh"], 2.0, load())
    scene = with_step(load(setting.changes))
    limit = coupling_limit_of(scene, scene.time.step)
    assert setting.name.startswith("mesh = 2, step x 0.") and 0.9 * limit < scene.time.step < limit
    assert borne(load, ()) == ((), 1.0)
    assert one_turn(load, BY_NAME["step"], 4.0, load()).name == "step = 4"  # the step is what is asked for


def test_a_budget_leaves_out_what_is_dear_first():
    load = reader("beam_vibration")
    knobs = knobs_of(load())
    whole = make_plan(load, knobs, {}, (), TERMS)
    cut = make_plan(load, knobs, {}, (), Terms(trial=TERMS.trial, samples=1, workers=1, budget=0.3 * whole.seconds))
    assert cut.seconds <= 0.3 * whole.seconds and cut.left_out
    assert {setting.role for setting in cut.settings} >= {"base", "reference"}
    kept = [setting.work for setting in cut.settings if setting.role == "knob"]
    assert kept and max(kept) <= min(setting.work for setting in cut.left_out)
    assert not any(setting.role == "finer" for setting in cut.settings)  # one level fits only


def test_seeds_are_those_of_whatever_is_laid_out_by_chance():
    assert seed_key(load_scene("bed")) == "grains.seed"
    assert seed_key(load_scene("elastic_tube")) == "bed.grains.seed"
    assert seed_key(load_scene("winkler_beam")) is None and seeds_of(load_scene("beam_vibration"), None) == ()
    assert len(seeds_of(load_scene("elastic_tube"), None)) == 5
    assert seeds_of(load_scene("bed", ["grains.seed=7"]), 3) == (7, 8, 9)
