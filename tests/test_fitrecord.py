"""What is said of a fit beside its numbers."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from ridecomfort import fitrecord


def test_starts_that_end_elsewhere_are_said_with_the_parameter_they_differ_in():
    task = SimpleNamespace(parameters=("one", "two"), values=lambda point: 10.0 * point)
    best, near, far = (
        SimpleNamespace(cost=cost, point=np.array(point)) for cost, point in ((1.0, (0.3, 0.5)), (1.005, (0.3, 0.5)), (1.2, (0.4, 0.1)))
    )
    assert fitrecord.of_starts(task, [best, near], best, []) == ([], [])
    (words,), in_doubt = fitrecord.of_starts(task, [best, far], best, [])
    assert words.startswith("starts disagree: the worst of 2 ends at a cost 20.0 % above") and "most in two, 1 against 5" in words
    assert in_doubt == [words]
    # That another start ends where the best does leaves no doubt of it.
    (words,), in_doubt = fitrecord.of_starts(task, [best, near, far], best, [])
    assert words.startswith("2 of 3 starts end at the best, the worst of 3 ends at a cost 20.0 % above") and words.endswith("most in two, 1 against 5")
    assert not in_doubt
    assert fitrecord.of_starts(task, [best], best, [])[1] == ["one start only: nothing tells whether another would end lower (calibration: restarts)"]
    assert fitrecord.of_starts(task, [best, near], best, ["spins"])[1] == ["1 of 3 starts led to a vehicle that does not drive (spins)"]
