"""Made-up studies that the tests of the report share."""

import pytest

from ridecomfort.report import claims, tables
from tests.report import synthetic


@pytest.fixture(scope="session")
def paper_like():
    """The three sites of the paper, stand-ins with drives, calibrated on ts1."""
    return synthetic.study()


@pytest.fixture(scope="session")
def own_site():
    """One site of a user's own: no drives, no published figures, no stand-in, eight runs."""
    return synthetic.study(("home",), drives=False, standin=False, runs=8)


@pytest.fixture(scope="session")
def made(paper_like):
    """All tables of the paper-like study, the claims included."""
    found = tables.make(paper_like)
    return found | claims.tables(paper_like, found)
