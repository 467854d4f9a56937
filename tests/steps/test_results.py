"""What is read of a study beside its own files."""

from __future__ import annotations

import json

from ridecomfort.steps import results

FRICTION, KNEE = ({"name": name, "sizes": []} for name in ("suspension_friction", "damper_knee"))


def of(drives):
    return {"sites": ["mysite"], "digests": {"mysite": drives, "second": "whatever"}}


def test_sizes_of_what_is_switched_on_are_those_of_the_last_verdict_without_it(tmp_path):
    def told(model, verdict, *effects, drives="as ever"):
        file = tmp_path / "diagnosis" / model / "verdict.json"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps({"verdict": verdict, "effects": effects, **of(drives)}))

    told("base", "named", FRICTION, KNEE)
    told("suspension_friction", "cluster", KNEE)
    told("body_bending", "named", FRICTION)
    told("damper_knee", "outside", FRICTION)
    told("damper_knee+suspension_friction", "named", {"name": "payload", "sizes": []})
    on = ("suspension_friction", "damper_knee")
    found = results._told_before(tmp_path, on, of("as ever"))
    assert {name: effect["model"] for name, effect in found.items()} == {"suspension_friction": "base", "damper_knee": "suspension_friction"}
    assert results._told_before(tmp_path, on, of("recorded anew")) == {} and results._told_before(tmp_path, (), of("as ever")) == {}
    told("base", "named", FRICTION, KNEE, drives="before the sensor was moved")
    assert "suspension_friction" not in results._told_before(tmp_path, on, of("as ever"))
