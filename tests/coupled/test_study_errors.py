"""What a study calls an error: intervals, the reference's own error, orders, the front."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from study_cases import QUANTITY, exactly, ran

from coupled.errors import LeitoError
from coupled.scene.quantities import ColumnOverTime
from coupled.study.judging.errors import judge, observed_order
from coupled.study.judging.front import beaten_by, front_of, pareto, price
from coupled.study.judging.judge import judge_all, references
from coupled.study.judging.reference import Reference, own_error, scale_of
from coupled.study.settings.setting import Ran, Setting

NUMBER = st.integers(min_value=0, max_value=8).map(float)  # few values, so that many points are equal


@given(st.lists(st.tuples(NUMBER, NUMBER), min_size=1, max_size=30))
def test_the_front_is_what_no_point_beats(points):
    def beaten(k):
        return any(other[0] <= points[k][0] and other[1] <= points[k][1] and other != points[k] for other in points)

    unbeaten = {points[k] for k in range(len(points)) if not beaten(k)}
    front = [points[k] for k in pareto(points)]
    assert set(front) == unbeaten
    assert front == sorted(front) and len(front) == len(set(front))


@pytest.mark.parametrize("order", [1.0, 2.0, 3.0])
def test_own_error_of_the_finest_level_is_the_true_one(order):
    """q = q0 + C h^p exactly: the estimate is exact, round-off apart."""
    levels = [7.0 + 0.3 * h**order for h in (1.0, 0.5, 0.25)]
    error, seen = own_error(levels)
    assert seen == pytest.approx(order, abs=1e-9)
    assert error == pytest.approx(levels[-1] - 7.0, rel=1e-9)


def test_own_error_is_not_flattered_by_luck():
    assert math.isnan(own_error([1.0])[0])
    assert own_error([1.0, 1.1])[0] == pytest.approx(0.1)  # as of order 1
    grown, order = own_error([1.0, 1.1, 1.4])  # the last change is the largest: nothing is left to believe in
    assert grown == pytest.approx(0.3) and order is None
    lucky, order = own_error([1.0, 2.0, 2.0 + 1e-9])  # as if of order 30
    assert order > 20 and lucky == pytest.approx(1e-9 / 15, rel=1e-6)


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 4.0])
def test_order_of_a_knob_beside_an_error_of_another_one(order):
    """What does not depend on the knob drops out."""
    pairs = [(step, 3.0 + 0.25 + 0.1 * step**order) for step in (2.0, 0.5, 1.0)]
    assert observed_order(pairs) == pytest.approx(order, abs=1e-6)


def test_no_order_from_two_values_uneven_steps_or_differences_that_grow():
    assert observed_order([(1.0, 2.0), (0.5, 1.5)]) is None
    assert observed_order([(1.0, 2.0), (0.5, 1.5), (0.4, 1.4)]) is None
    assert observed_order([(1.0, 2.0), (0.5, 1.9), (0.25, 1.2)]) is None


def judged_samples(difference: float, seeds: int, random: np.random.Generator):
    """A setting and its reference on the same packings: the packing's share is common, the rest chaos."""
    packing, chaos = 0.2 * random.standard_normal(seeds), 0.05 * random.standard_normal((2, seeds))
    right = Reference(samples=tuple(1.0 + packing + chaos[0]), error=0.0, source="finest", scale=1.0)
    return judge(ran("a", 1.0, 1.0 + difference + packing + chaos[1]), QUANTITY, right, chance=True)


def test_chance_is_called_resolved_in_five_percent_of_cases():
    random, cases = np.random.default_rng(1), 4000
    false = sum(judged_samples(0.0, 5, random).verdict == "resolved" for _ in range(cases))
    # binomial: 5 % of 4000 within four standard deviations
    assert abs(false - 0.05 * cases) < 4 * math.sqrt(cases * 0.05 * 0.95)


def test_seeds_shared_with_the_reference_resolve_what_packings_would_hide():
    """A difference of 0.15 is below the scatter of packings, 0.2, and three times that of chaos."""
    random = np.random.default_rng(2)
    seen = sum(judged_samples(0.15, 5, random).verdict == "resolved" for _ in range(200))
    assert seen > 180


def test_verdicts():
    finest = Reference(samples=(1.0,), error=0.02, source="finest", scale=1.0)
    assert judge(ran("a", 1.0, [1.01]), QUANTITY, finest, chance=False).verdict == "below the reference's own error"
    assert judge(ran("a", 1.0, [1.03]), QUANTITY, finest, chance=False).verdict == "resolved"
    assert judge(ran("a", 1.0, [1.03]), QUANTITY, finest, chance=True).verdict == "one sample"
    itself = judge(ran("finest", 1.0, [1.0], role="reference"), QUANTITY, finest, chance=False)
    assert itself.verdict == "reference" and itself.known == pytest.approx(0.02)


def test_luck_does_not_lead_the_front():
    """A mean that happens to lie on the reference is worth no more than its interval."""
    right = Reference(samples=(0.9, 1.0, 1.1), error=0.0, source="finest", scale=1.0)
    lucky = judge(ran("lucky", 1.0, [1.4, 1.0, 0.6]), QUANTITY, right, chance=True)
    steady = judge(ran("steady", 2.0, [0.95, 1.05, 1.15]), QUANTITY, right, chance=True)
    assert lucky.error == pytest.approx(0.0, abs=1e-12) and lucky.known > 1.0
    assert front_of([lucky, steady]) == [lucky, steady]
    assert steady.known < lucky.known


def test_price_of_a_digit_and_who_is_beaten():
    """From 1e-1 in 1 s over 1e-2 in 3 s to 1e-3 in 7 s: two digits for six seconds."""
    runs = [("4", 1.0, 1.1), ("2", 3.0, 1.01), ("1", 7.0, 1.001), ("slow", 9.0, 1.05)]
    items = [
        judge(ran(name, wall, [value], knob=("step", name)), QUANTITY, exactly(1.0), chance=False)
        for name, wall, value in runs
    ]
    assert price("step", items).seconds_per_decade == pytest.approx(3.0)
    assert [beaten_by(item, items) for item in items[:3]] == [None] * 3
    assert beaten_by(items[3], items).setting.name == "1"
    assert math.isinf(price("step", items[3:]).seconds_per_decade)


def test_equal_speed_within_a_margin_beats_nobody():
    items = [
        judge(ran(name, wall, [value]), QUANTITY, exactly(1.0), chance=False)
        for name, wall, value in (("a", 1.0, 1.01), ("b", 0.97, 1.01))
    ]
    assert beaten_by(items[0], items) is None


def test_scale_of_a_quantity_that_is_nearly_nothing():
    assert scale_of(-2.0, [1.0, 5.0]) == 2.0
    assert scale_of(1e-12, [1.0, -5.0]) == 5.0
    assert scale_of(0.0, [0.0]) == 1.0


def quantity(**more):
    return ColumnOverTime(name=QUANTITY, kind="drop", column="centroid_y", **more)


def levels(*values, knob=("mesh", "level 2")):
    """The base and two levels of refinement, each of some samples."""
    roles = ("base", "finer", "reference")
    return [
        ran(role, 1.0, samples, role=role, knob=None if role == "base" else knob)
        for role, samples in zip(roles, values, strict=True)
    ]


def test_a_closed_form_that_the_levels_go_past_has_an_error_of_its_own():
    """Order 2 towards 1.0, beside a theory that says 1.1."""
    runs = levels([1.16], [1.04], [1.01])
    found = references(runs, [quantity(exact=1.1)], chance=False)[QUANTITY]
    assert found.mean == 1.1 and found.error == pytest.approx(0.09 - 0.01)
    assert judge(runs[1], QUANTITY, found, chance=False).verdict == "below the reference's own error"
    agreeing = references(runs, [quantity(exact=1.0)], chance=False)[QUANTITY]
    assert agreeing.error == 0.0


def test_a_given_reference_does_not_know_its_error():
    runs = levels([1.16], [1.04], [1.01])
    given = ran("finest", 1.0, [1.01], role="reference")
    assert math.isnan(references([runs[0], given], [quantity()], chance=False)[QUANTITY].error)
    assert references(runs, [quantity()], chance=False)[QUANTITY].error == pytest.approx(0.01)


def test_levels_that_chance_hides_are_no_error():
    runs = levels([1.0, 1.4, 0.7], [1.2, 0.9, 1.1], [0.9, 1.2, 1.0])
    found = references(runs, [quantity()], chance=True)[QUANTITY]
    assert found.open and found.error == 0.0
    apart = references(levels([2.0, 2.1, 2.2], [1.5, 1.6, 1.71], [1.25, 1.35, 1.45]), [quantity()], chance=True)
    assert not apart[QUANTITY].open and apart[QUANTITY].error > 0.2


def test_errors_are_over_the_scale_that_a_quantity_names():
    found = references(levels([3.0], [3.0], [2.0]), [quantity(scale=4.0)], chance=False)[QUANTITY]
    assert judge(ran("a", 1.0, [3.0]), QUANTITY, found, chance=False).error == pytest.approx(0.25)


def test_a_quantity_that_a_setting_lacks_is_compared_among_those_that_have_it():
    runs = levels([1.16], [1.04], [1.01])
    lacking = Ran(
        setting=Setting(name="b", role="knob"), status="done", message="late is not known", values={"on": (1.0,)}
    )
    found = references([*runs, lacking], [quantity()], chance=False)
    assert found[QUANTITY].mean == 1.01
    assert len(judge_all([*runs, lacking], found, chance=False)[QUANTITY]) == 3
    other = quantity(exact=1.0).model_copy(update={"name": "on"})
    rare = quantity().model_copy(update={"name": "on"})
    assert set(references([*runs, lacking], [quantity(), other], chance=False)) == {QUANTITY, "on"}
    assert set(references([*runs, lacking], [quantity(), rare], chance=False)) == {QUANTITY}  # no reference has it
    assert lacking.lacking == "late is not known"
    with pytest.raises(LeitoError, match="no setting of this study has any of its quantities: late is not known"):
        references([lacking], [quantity(exact=1.0)], chance=False)


def test_without_a_finest_level_there_is_nothing_to_measure_against():
    runs = levels([1.0], [1.0], [1.0])[:1]
    refused = Ran(setting=Setting(name="finest", role="reference"), status="refused", message="r = 3 is above 2")
    with pytest.raises(LeitoError, match="has no drop: refused: r = 3 is above 2; give another"):
        references([*runs, refused], [quantity()], chance=False)
    assert references([*runs, refused], [quantity(exact=1.0)], chance=False)[QUANTITY].error == 0.0
