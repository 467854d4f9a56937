"""An instrument that swings on what holds it."""

from math import pi

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="sensor_mount",
    sentence=(
        "The instrument sits on foam, a bracket or a holder that gives: around the natural frequency of that it is shaken more than "
        "the body at its place, and less above it."
    ),
    source=(
        "ISO 5348:2021, Mechanical vibration and shock: mechanical mounting of accelerometers; spring-mass oscillator with a moving base "
        "as in any textbook of vibration"
    ),
    port="sensor",
    parameters=(
        Parameter("vertical", "1", 0.0, 0.3, (0.0, 1.6), "share of its own motion in the mode, up and down: 1 on foam, 1.57 at the tip of a bracket"),
        Parameter("sideways", "1", 0.0, 0.3, (0.0, 1.6), "the same to the side"),
        Parameter("frequency", "Hz", 15.0, 15.0, (6.0, 40.0), "natural frequency of the mode"),
        Parameter("damping_ratio", "1", 0.15, 0.15, (0.02, 0.5), "damping ratio of the mode"),
    ),
)


def act(drive, vertical, sideways, frequency, damping_ratio):
    shares = {name: share for name, share in (("a_z", vertical), ("a_y", sideways)) if share != 0.0}
    if not shares:
        return drive
    from scipy.signal import cont2discrete, lfilter, lfilter_zi  # here: they take half a second, and the library is read at every start

    time = drive["time"].values
    turns = 2.0 * pi * frequency
    mode = ([-1.0, 0.0, 0.0], [1.0, 2.0 * damping_ratio * turns, turns * turns])
    # The exact answer to a signal that is straight between its samples.
    (ahead,), back, _ = cont2discrete(mode, float(time[1] - time[0]), "foh")
    rest = lfilter_zi(ahead, back)
    swung = {name: lfilter(ahead, back, drive[name].values, zi=rest * drive[name].values[0])[0] for name in shares}
    return drive.assign({name: drive[name].copy(data=drive[name].values + shares[name] * change) for name, change in swung.items()})
