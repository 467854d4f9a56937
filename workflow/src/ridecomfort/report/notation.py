r"""Text with a little TeX mathematics in it, turned into LaTeX, HTML and plain text.

Captions and headings are written once, as ``$R_c$ [%]``. Between dollar signs stand letters,
Greek letters as commands, subscripts (``_x`` or ``_{x,PT}``), superscripts and ``\pm``. ``\$`` is the sign itself
(``literal``), as matplotlib has it.
"""

from __future__ import annotations

import html as _html
import re

from ..discrepancy.terms import SIDE, TURNING, WHIRL

SYMBOLS = {
    "v_x": "$v_x$",
    "a_x": "$a_x$",
    "a_y": "$a_y$",
    "a_z": "$a_z$",
    "a_v": "$a_v$",
    "roll_rate": r"$\Phi$-rate",
    "pitch_rate": r"$\Theta$-rate",
    "yaw_rate": r"$\Psi$-rate",
    "speed_deviation": r"$v_{dev}$",
    "lateral_position": "$l_p$",
    "road_friction": r"$\mu_{rs}$",
    "spring_stiffness_front": "$K_{sf}$",
    "spring_stiffness_rear": "$K_{sr}$",
    "tyre_friction": r"$\mu_T$",
    "tyre_radial_stiffness": "$K_{Tr}$",
    "tyre_radial_damping": "$d_{Tr}$",
    "iri": "IRI",
}
"""How the paper writes what the study's files name."""

METHODS = {"thresholds": "thresholding", "iso2631": "ISO 2631", "iri": "IRI"}
"""How the paper calls the comfort methods."""

POWERS = {"2": "²", "3": "³"}
"""Whole powers of a unit of the files as they are printed."""

_COMMANDS = {
    r"\Phi": "Φ",
    r"\Theta": "Θ",
    r"\Psi": "Ψ",
    r"\lambda": "λ",
    r"\mu": "μ",
    r"\sigma": "σ",
    r"\pm": "±",
    r"\times": "×",
    r"\to": "→",
    r"\le": "≤",
}
_LATEX = {
    "\\": r"\textbackslash{}",
    "$": r"\$",
    "^": r"\textasciicircum{}",
    "%": r"\%",
    "&": r"\&",
    "#": r"\#",
    "_": r"\_",
    "~": r"\textasciitilde{}",
    "{": r"\{",
    "}": r"\}",
    "²": "$^2$",
    "³": "$^3$",
    "⁴": "$^4$",
    "λ": r"$\lambda$",
    "±": r"$\pm$",
    "†": r"$^\dagger$",
    "‡": r"$^\ddagger$",
    "–": "--",
    "−": "$-$",
    "<": "$<$",
    ">": "$>$",
    "≤": r"$\le$",
    "→": r"$\to$",
    "×": r"$\times$",
    "μ": r"$\mu$",
    "σ": r"$\sigma$",
    "Σ": r"$\Sigma$",
    "·": r"$\cdot$",
    "π": r"$\pi$",
}


_IN_FORMULAS = (
    (r"(\w+) \+= ", r"\1 → \1 + "),
    (r"\bmotion\.", ""),
    (r"\*\*2\b", "²"),
    (r"\*\*3\b", "³"),
    (r" \* ", " · "),
    (r"\b6\.283[12]\d*\b", "2π"),
    (r"\b(\d+)\.0\b", r"\1"),
    (r"-", "−"),
)
"""What of Python is written otherwise in a formula, one after the other."""


def symbol(name: str) -> str:
    """The symbol of a variable as marked-up text; a name without a symbol in words."""
    return SYMBOLS.get(name, words(name))


def signal(name: str) -> str:
    """A signal where model and measurement are compared: accelerations by symbol, rates in words."""
    return words(name) if name.endswith("_rate") else symbol(name)


def words(name: str) -> str:
    """A name of the files in words: ``suspension friction: front`` for ``suspension_friction.front``."""
    return name.replace("_", " ").replace(".", ": ")


def formula(text: str) -> str:
    """A form as ``discrepancy.form`` writes it, or an expression of its terms, in usual notation, ``deflection² · side``, where side is +1 on the
    left and -1 on the right."""
    text = text.replace(SIDE, "side")
    for part in (*TURNING, *WHIRL):
        text = text.replace(part, words(part))
    for written, usual in _IN_FORMULAS:
        text = re.sub(written, usual, text)
    return text


def unit(name: str) -> str:
    """A unit of the files as it is printed."""
    return "-" if name == "1" else re.sub(r"(?<=[a-z])([23])(?![.\d])", lambda found: POWERS[found[1]], name)


def literal(text: str) -> str:
    """What a user wrote, such as a title, as marked-up text that shows it as it is."""
    return str(text).replace("$", r"\$")


def plain(text: str) -> str:
    """The text without markup, for Markdown and alternative texts: ``a_x``, ``Φ-rate``."""
    return _convert(text, outside=str, inside=lambda math: re.sub(r"[{}]", "", _unicode(math)))


def html(text: str) -> str:
    """The text as HTML, mathematics in italics with subscripts and superscripts."""
    return _convert(text, outside=_html.escape, inside=_html_math)


def latex(text: str) -> str:
    """The text as LaTeX with everything outside mathematics escaped."""
    escape = lambda part: "".join(_LATEX.get(letter, letter) for letter in part)  # noqa: E731
    return _convert(text, outside=escape, inside=lambda math: f"${math}$")


def _convert(text, outside, inside) -> str:
    parts = re.split(r"(?<!\\)\$", str(text))
    return "".join(inside(part) if odd % 2 else outside(part.replace(r"\$", "$")) for odd, part in enumerate(parts))


def _unicode(math: str) -> str:
    for command in sorted(_COMMANDS, key=len, reverse=True):
        math = re.sub(re.escape(command) + r"(?![A-Za-z]) ?", _COMMANDS[command], math)
    return math


def _html_math(math: str) -> str:
    text = _html.escape(_unicode(math))
    text = re.sub(r"_(?:\{([^}]*)\}|(\w))", lambda m: f"<sub>{m[1] or m[2]}</sub>", text)
    text = re.sub(r"\^(?:\{([^}]*)\}|(\w))", lambda m: f"<sup>{m[1] or m[2]}</sup>", text)
    return re.sub(r"(?<![\w<&/])([A-Za-zΑ-ω])(?=<su[bp]>|$)", r"<i>\1</i>", text)
