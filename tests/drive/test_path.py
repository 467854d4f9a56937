"""The path of a drive beside the one that is recorded."""

from __future__ import annotations

import pytest

from ridecomfort.drive import path


@pytest.mark.parametrize(("around", "found"), [(None, 0.0), (0.3, 0.3), (-0.5, -0.5)])
def test_a_search_without_room_ends_where_it_begins(around, found, monkeypatch):
    """Where the road is hardly wider than the car no other path is tried."""
    beginning = around or 0.0
    monkeypatch.setattr(path, "free", lambda work, road: (beginning - 0.05, beginning + 0.05))
    monkeypatch.setattr(path, "part", lambda work: work)
    assert path.find_offset(None, None, None, None, {}, around) == pytest.approx(found)
