"""Directions whose usual sizes are known, taken out of white series; most are there along a part of the road only.

Each row is what an error of the usual size does. Taking as much of it as is likely (a normal distribution of that size), and not as
much as helps, is to weigh a series by the covariance of its noise and of the rows together (Rasmussen and Williams 2006, eq. 2.40):
a path that may be wrong by some centimetres does not bend by a metre to make room for a force.

What alignment may get wrong of clock and path is a sum of splines, each a few seconds long. Whole
rows of them would be read for every projection; what is there within a stretch of a few seconds is a twentieth of that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from .spectrum import Whitening

MEMORY = 2.0
"""s that a white series rings on beyond the one it was made from; what is later is less than a hundredth."""


CHUNK = 256
"""Samples of the stretches that white rows are kept by."""


@dataclass(frozen=True)
class Piece:
    """Rows (row, channel, sample) of a matrix that are nil before ``start`` and behind the samples that they have."""

    numbers: np.ndarray
    start: int
    rows: np.ndarray

    @property
    def place(self) -> slice:
        """The samples that it covers."""
        return slice(self.start, self.start + self.rows.shape[-1])

    def flat(self) -> np.ndarray:
        """The rows as vectors."""
        return self.rows.reshape(len(self.rows), -1)


@dataclass(frozen=True)
class Rows:
    """The ``pieces`` of a matrix (direction, channel, sample) of ``count`` directions and ``total`` samples."""

    pieces: list[Piece]
    count: int
    total: int


def taken_apart(rows: np.ndarray) -> Rows:
    """Rows (direction, channel, sample) by where they are not nil."""
    there = np.any(rows != 0, axis=1)
    first = np.argmax(there, axis=1)
    last = np.where(there.any(axis=1), rows.shape[-1] - np.argmax(there[:, ::-1], axis=1), first)
    ends, which = np.unique(np.stack([first, last], axis=1), axis=0, return_inverse=True)
    found = []
    for k, (start, stop) in enumerate(ends):
        numbers = np.flatnonzero(which.ravel() == k)
        if stop > start:
            found.append(Piece(numbers, int(start), rows[numbers, :, start:stop]))
    return Rows(found, len(rows), rows.shape[-1])


def by_stretch(pieces: Sequence[Piece], total: int) -> list[Piece]:
    """The same, all rows that are there within one stretch of CHUNK samples side by side."""
    found = []
    for start in range(0, total, CHUNK):
        stop = min(start + CHUNK, total)
        there = [piece for piece in pieces if piece.start < stop and piece.place.stop > start]
        if not there:
            continue
        numbers = np.concatenate([piece.numbers for piece in there])
        rows = np.zeros((len(numbers), there[0].rows.shape[1], stop - start), there[0].rows.dtype)
        first = 0
        for piece in there:
            low, high = max(piece.start, start), min(piece.place.stop, stop)
            own = rows[first : first + len(piece.numbers)]
            own[..., low - start : high - start] = piece.rows[..., low - piece.start : high - piece.start]
            first += len(piece.numbers)
        found.append(Piece(numbers, start, rows))
    return found


@dataclass
class Span:
    """The ``rows`` after they have been made ``white``, by stretch."""

    rows: Rows
    whitening: Whitening
    white: list[Piece] = field(init=False)

    def __post_init__(self):
        self.white = by_stretch([self._whitened(piece) for piece in self.rows.pieces], self.rows.total)
        values, vectors = np.linalg.eigh(self._normal())
        root = np.sqrt(1.0 + np.maximum(values, 0.0))
        self._inverse = (vectors / root**2) @ vectors.T
        self._half = (vectors / (root * (1.0 + root))) @ vectors.T

    def amounts(self, white: np.ndarray) -> np.ndarray:
        """Likely amounts (..., direction) of the rows in white series (..., channel, sample)."""
        return self._products(white) @ self._inverse

    def without(self, white: np.ndarray) -> np.ndarray:
        """White series (..., channel, sample) whose sum of squares is what is left of theirs, that of the likely amounts included."""
        return _less(white, self._products(white) @ self._half, self.white)

    def cleaned(self, series: np.ndarray) -> np.ndarray:
        """A series (channel, sample) less the amounts of the raw rows that it holds when white."""
        return _less(series, self.amounts(self.whitening(series)), self.rows.pieces)

    def shares(self, white: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Power of white series (column, channel, sample) that is left of them, and in all, (column,)."""
        products = self._products(white)
        power = np.einsum("cij,cij->c", white, white).astype(float)
        return power - np.einsum("cd,de,ce->c", products, self._inverse, products), power

    def _products(self, white: np.ndarray) -> np.ndarray:
        found = np.zeros((*white.shape[:-2], self.rows.count))
        for piece in self.white:
            part = white[..., piece.place].astype(piece.rows.dtype).reshape(*white.shape[:-2], -1)
            found[..., piece.numbers] += part @ piece.flat().T
        return found

    def _whitened(self, piece: Piece) -> Piece:
        margin = int(MEMORY * self.whitening.rate)
        start, stop = max(piece.start - margin, 0), min(piece.place.stop + margin, self.rows.total)
        before, behind = piece.start - start, stop - piece.place.stop
        padded = np.pad(piece.rows, ((0, 0), (0, 0), (before, behind)))
        return Piece(piece.numbers, start, self.whitening(padded, start, self.rows.total))

    def _normal(self) -> np.ndarray:
        normal = np.zeros((self.rows.count, self.rows.count))
        for piece in self.white:
            normal[np.ix_(piece.numbers, piece.numbers)] += piece.flat() @ piece.flat().T
        return normal


def _less(series: np.ndarray, amounts: np.ndarray, own: list[Piece]) -> np.ndarray:
    left = series.copy()
    for piece in own:
        part = (amounts[..., piece.numbers].astype(piece.rows.dtype) @ piece.flat()).reshape(*series.shape[:-1], -1)
        left[..., piece.place] -= part
    return left
