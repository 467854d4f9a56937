"""IRI of profiles: against another way to compute it, by segments, tracks and irregular spacing."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ridecomfort.comfort import iri, quartercar
from ridecomfort.errors import InputError


def rough(length: float = 300.0, spacing: float = 0.1, seed: int = 1, waves: int = 60):
    """A smooth profile of sines of 2 to 40 m with the spectrum of a road, as positions and a function."""
    rng = np.random.default_rng(seed)
    numbers = np.linspace(1 / 40, 1 / 2, waves)
    amplitudes, phases = 4e-4 / numbers / np.sqrt(waves), rng.uniform(0, 2 * np.pi, waves)

    def height(s):
        return np.sum(amplitudes * np.sin(2 * np.pi * numbers * np.asarray(s)[..., None] + phases), axis=-1)

    return np.arange(0, length + spacing / 2, spacing), height


def test_against_the_equations_integrated_by_runge_kutta():
    """sec:IRI_concept, put right (docs/method.md), in heights instead of slopes, by scipy's own solver."""
    s, height = rough(120.0, 0.02)
    a, b = quartercar.GOLDEN_CAR.matrices()
    v = quartercar.SPEED
    slope = (height(11.0) - height(0.0)) / 11.0 * v

    def derivative(t, x):
        state = a @ x[:4] + b * height(v * t)
        return np.append(state, abs(x[1] - x[3]))

    start = np.array([height(0.0), slope, height(0.0), slope, 0.0])
    solution = solve_ivp(derivative, (0, 120.0 / v), start, method="DOP853", rtol=1e-9, atol=1e-12, max_step=0.01)
    expected = 1000 * solution.y[4, -1] / 120.0
    # Slopes of the state and of the solver's start differ by the static deflection, which the first metres forget.
    assert iri.iri(height(s), 0.02, moving_average=None) == pytest.approx(expected, rel=2e-3)


def test_irregular_spacing_gives_the_same_as_equal_spacing():
    s, height = rough(300.0, 0.05)
    rng = np.random.default_rng(2)
    uneven = s + np.concatenate([[0.0], rng.uniform(-0.02, 0.02, len(s) - 2), [0.0]])
    for average in (None, 0.25):
        equal = iri.iri(height(s), 0.05, 100.0, moving_average=average)
        assert iri.iri(height(uneven), uneven, 100.0, moving_average=average) == pytest.approx(equal, rel=3e-3)


def test_positions_and_spacing_are_two_ways_to_say_the_same():
    s, height = rough()
    assert iri.iri(height(s), s, 50.0) == pytest.approx(iri.iri(height(s), 0.1, 50.0), rel=1e-9)


def test_moving_average_is_sayers_on_equal_spacing():
    """Slope over a whole number of intervals nearest to 250 mm (Sayers 1995), here 3 of 0.1 m, by plain loops."""
    s, height = rough(150.0)
    profile = height(s)
    st, pr = quartercar.transition(0.1)
    slopes = (profile[3:] - profile[:-3]) / 0.3
    x = np.array([1.0, 0.0, 1.0, 0.0]) * (profile[110] - profile[0]) / 11.0
    strokes = []
    for slope in slopes:
        x = st @ x + pr * slope
        strokes.append(abs(x[0] - x[2]))
    expected = 1000 * np.mean(strokes[300:1300])
    response = quartercar.respond(profile, 0.1)
    assert float(response.between(30.1, 130.1)) == pytest.approx(expected, rel=5e-3)


def test_state_is_carried_across_segments_and_calls():
    s, height = rough(200.0, 0.1)
    profile = height(s)
    whole = quartercar.respond(profile, 0.1, moving_average=None)
    first = quartercar.respond(profile[:1001], 0.1, moving_average=None)
    second = quartercar.respond(profile[1000:], 0.1, moving_average=None, state=first.state)
    assert first.travel[-1] + second.travel[-1] == pytest.approx(whole.travel[-1], rel=1e-12)
    assert np.allclose(second.state, whole.state, rtol=1e-9)
    parts = iri.iri(profile, 0.1, 50.0)
    assert parts.mean() == pytest.approx(float(iri.iri(profile, 0.1)), rel=1e-9)


def test_a_plane_has_no_roughness_and_roughness_is_linear():
    s, height = rough()
    assert iri.iri(0.03 * s, 0.1) == pytest.approx(0.0, abs=1e-9)
    tilted = 3.0 * height(s) + 0.02 * s + 500.0
    assert iri.iri(tilted, 0.1) == pytest.approx(3.0 * iri.iri(height(s), 0.1), rel=1e-6)


def test_what_is_kept_of_a_transition_cannot_be_changed():
    for kept in quartercar.transition(0.25):
        with pytest.raises(ValueError, match="read-only"):
            kept[:] = 0.0


def test_tracks():
    s, left = rough(seed=1)
    _, right = rough(seed=2)
    left, right = left(s), right(s)
    mean = iri.mean_of_tracks(left, right, 0.1, 100.0)
    assert mean == pytest.approx(0.5 * (iri.iri(left, 0.1, 100.0) + iri.iri(right, 0.1, 100.0)))
    assert np.all(iri.half_car(left, right, 0.1, 100.0) < mean)
    assert iri.half_car(left, left, 0.1) == pytest.approx(iri.iri(left, 0.1))
    assert iri.half_car(left, -left, 0.1) == pytest.approx(0.0, abs=1e-9)


def test_sliding_and_survey():
    s, height = rough(500.0)
    profile = height(s)
    segments = iri.iri(profile, 0.1, 50.0)
    middles = 25.0 + 50.0 * np.arange(10)
    assert iri.sliding(profile, 0.1, middles, 50.0) == pytest.approx(segments)
    assert iri.survey(profile, 0.1, middles) == pytest.approx(segments)
    assert iri.survey(profile, 0.1, [0.0, 50.0, 500.0]) == pytest.approx(
        [segments[0], segments[:2].mean(), segments[-1]]
    )


def test_local_roughness_finds_the_step():
    """What a survey of 50 m hides: a step of 20 mm at 260 m."""
    s = np.arange(0, 500, 0.1)
    profile = np.where(s < 260.0, 0.0, 0.02)
    found = iri.local_roughness(profile, 0.1, threshold=4.0)
    assert len(found) == 1
    assert found[0]["start"] < 260.0 < found[0]["stop"] < 275.0
    assert found[0]["peak"] > 2.5 * iri.survey(profile, 0.1, s).max()


@pytest.mark.parametrize("beginning", [0.0, 0.3, 28.3, 1234.5])
@pytest.mark.parametrize("spacing", [0.1, 0.02])
def test_where_a_profile_begins_does_not_matter(beginning, spacing):
    """The moving average stands on the edge of a half interval at 0.1 m: 3 intervals (Sayers 1995), whatever the last digit of a position."""
    s, height = rough(200.0, spacing)
    assert iri.iri(height(s), beginning + s) == pytest.approx(iri.iri(height(s), spacing), rel=1e-6)


def test_a_short_rest_is_left_out():
    assert iri.segments(0.0, 999.9, 100.0)[0].size == 10
    assert iri.segments(0.0, 1040.0, 100.0)[0].size == 10


@pytest.mark.parametrize(
    "arguments, message",
    [
        (([0.0, np.nan, 0.0], 0.1), "sample 1"),
        (([0.0, 1.0, 0.0], [0.0, 0.2, 0.1]), "ascend"),
        (([0.0, 1.0, 0.0], 0.0), "spacing"),
        (([0.0], 0.1), "two heights"),
        ((np.zeros(100), 0.1, 50.0), "more than twice as long as the profile"),
        ((np.zeros(100), 0.1, -5.0), "not a length"),
    ],
)
def test_mistakes_are_named(arguments, message):
    with pytest.raises(InputError, match=message):
        iri.iri(*arguments)
