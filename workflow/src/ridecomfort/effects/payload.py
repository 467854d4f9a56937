"""Passengers and luggage that the parameters of the car leave out."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="payload",
    sentence=(
        "Passengers and luggage add mass where they sit: the centre of gravity moves towards them and the inertia "
        "grows by the parallel-axis theorem. The car stands as high as without them, as one that levels itself; on plain springs the "
        "centre of gravity would also sink by a centimetre or so per 100 kg."
    ),
    source="parallel-axis theorem; 75 kg for an occupant as in ISO 2416:1992",
    port="vehicle",
    parameters=(
        Parameter("mass", "kg", 0.0, 150.0, (0.0, 800.0), "mass added to the sprung mass"),
        Parameter("ahead", "m", -0.8, -0.8, (-3.0, 2.0), "its place ahead of the centre of gravity of the car"),
        Parameter("height", "m", 0.6, 0.6, (0.2, 2.0), "its height above the road"),
        Parameter("radius", "m", 0.3, 0.3, (0.0, 1.5), "its radius of gyration about each of its own axes"),
    ),
)


def act(vehicle, mass, ahead, height, radius):
    above = height - vehicle["cg_height"]
    total = vehicle["sprung_mass"] + mass
    share = mass / total
    reduced = share * vehicle["sprung_mass"]
    own = mass * radius**2
    return vehicle.replace(
        sprung_mass=total,
        cg_to_front_axle=vehicle["cg_to_front_axle"] - share * ahead,
        cg_height=vehicle["cg_height"] + share * above,
        roll_inertia=vehicle["roll_inertia"] + own + reduced * above**2,
        pitch_inertia=vehicle["pitch_inertia"] + own + reduced * (ahead**2 + above**2),
        yaw_inertia=vehicle["yaw_inertia"] + own + reduced * ahead**2,
    )
