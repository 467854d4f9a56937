"""A verdict, an effect that it names, and a force of any form, as a search may come to them."""

from __future__ import annotations

from dataclasses import replace

from ridecomfort.discrepancy.discovery import Discovery
from ridecomfort.discrepancy.off_file import Held, OffFile
from ridecomfort.discrepancy.verdict import Named, Verdict

NOTHING = Verdict("nothing", (), ("the floor is known from repeats",), 0.0, 0.0)

OUTSIDE = replace(NOTHING, verdict="outside", share=0.6, held_out_share=0.58)

SIZE = {"parameter": "compliance", "size": 2e-6, "unit": "rad/N", "interval": [1.9e-6, 2.1e-6], "interval_of_noise": [1.9e-6, 2.1e-6],
        "plausible": [0.0, 4e-6], "is_plausible": True}  # fmt: skip

FOUND = Named("friction", (), "", 0.001, 0.3, 0.3, 0.0, (), {})

KNEE = replace(FOUND, name="damper_knee")

HELD = OffFile((Held("roll_inertia", "kg m2", 572.0, 589.0, (588.0, 590.0)),), {"roll_rate": 0.002})

SURE = Discovery("discovered", "tyre", "tyre_vertical", {"once_a_turn": {"front_left_sine": 60.0}}, {"once_a_turn": {}}, "force = ...", 0.9, 0.9, 0.0015, "", {}, None)
