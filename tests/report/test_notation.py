"""Marked-up text in its three forms."""

import re

import pytest

from ridecomfort.discrepancy.places import PLACES
from ridecomfort.discrepancy.terms import SIDE
from ridecomfort.report import notation


@pytest.mark.parametrize(
    "text, plain, html, latex",
    [
        ("$R_c$ [%]", "R_c [%]", "<i>R</i><sub>c</sub> [%]", r"$R_c$ [\%]"),
        (r"$\pm a_{x,PT}$", "±a_x,PT", "±<i>a</i><sub>x,PT</sub>", r"$\pm a_{x,PT}$"),
        (r"$\Phi$-rate", "Φ-rate", "<i>Φ</i>-rate", r"$\Phi$-rate"),
        ("road_friction < 1", "road_friction < 1", "road_friction &lt; 1", r"road\_friction $<$ 1"),
        ("m/s² & −1", "m/s² & −1", "m/s² &amp; −1", r"m/s$^2$ \& $-$1"),
        (r"from \$5 to \$9 & 50 %", "from $5 to $9 & 50 %", "from $5 to $9 &amp; 50 %", r"from \$5 to \$9 \& 50 \%"),
        (r"\$5 on $R_c$", "$5 on R_c", "$5 on <i>R</i><sub>c</sub>", r"\$5 on $R_c$"),
        ("2π · a", "2π · a", "2π · a", r"2$\pi$ $\cdot$ a"),
    ],
)
def test_forms(text, plain, html, latex):
    assert notation.plain(text) == plain
    assert notation.html(text) == html
    assert notation.latex(text) == latex


@pytest.mark.parametrize("text", ["A $5 road & 50 % | $ more_or_less", r"C:\$x$", "no sign"])
def test_what_a_user_wrote_is_shown_as_it_is(text):
    assert notation.plain(notation.literal(text)) == text


def test_symbols_and_units_of_the_vocabulary():
    assert notation.symbol("a_z") == "$a_z$"
    assert notation.symbol("suspension_friction.front") == "suspension friction: front"
    assert notation.signal("a_z") == "$a_z$" and notation.signal("pitch_rate") == "pitch rate"
    assert notation.unit("m/s2") == "m/s²"
    assert notation.unit("m/km") == "m/km"
    assert [notation.unit(name) for name in ("1", "m2", "kg m2", "rad/s2", "1/rad2", "m/s1.75")] == ["-", "m²", "kg m²", "rad/s²", "1/rad²", "m/s1.75"]


def test_every_term_of_a_force_is_written_without_python():
    for place in PLACES.values():
        for term in place.terms.values():
            written = [notation.formula(text) for text in (term.expression, term.turn, *(state.slope for state in term.states))]
            assert not re.search(r"\*|%|motion|\d\.0\b|\+=", " ".join(written)), written
    assert notation.formula(f"-6.2832 * way + motion.speed**2 * {SIDE}") == "−2π · way + speed² · side"
    assert notation.formula("(60 N front_left_cosine)") == "(60 N front left cosine)"
    assert notation.formula("(3 N aside_sine) of 6.283185 * motion.s / period") == "(3 N aside sine) of 2π · s / period"
