"""A model driven along the measured path at the measured speed, brought to the measured time base.

The simulator is a door: any callable with the signature of ``simulate.run``. Its record
passes through the same low-pass as the measured one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import xarray as xr

from ..errors import InputError
from ..vehicle.driver import path_demand, speed_demand
from ..vocabulary import SIGNALS, STANDARD_GRAVITY
from . import pedals
from .distance import DIFFERENTIATED
from .record import upward
from .sampling import integral, rate_of, resampled, resampled_slopes
from .sensor import displacement
from .slow import smooth, speed_bandwidth

RUN_IN = 50.0
"""m that the model drives before it is compared: 2 s at 25 m/s, when a bounce of 1.3 Hz, damped by a third, is down to
0.5 %."""

MARGIN = 2.0
"""m of road beyond a drive at either end that the model is driven on, unless told."""

SLOWEST = 1.0
"""m/s; equal place means nothing for a vehicle that stands."""

INTERVAL = 0.001
"""s; the model is recorded at this interval or the next whole number of its steps. At 250 Hz the error of filtering a
record and interpolating in it, 0.2 percent, was a bias of 1.5 percent of the bounds in the damping of the tyre."""

CLOCK_LEFT = 1e-3
"""s that alignment may be off by. A model is compared at its best clock within it and not beyond: a delay of
3 ms looks like a damping of the tyre, and a wrong damping like a delay."""

DELAY_BANDWIDTH, DELAY_ORDERS = 0.4, {"speed": 2, "lateral": 4}
"""Hz up to which a driver model's delay is made up for, and how steeply the filter falls beyond. What is faster in a recorded speed
is mostly noise (but see ``pedals``), and in a path the vehicle does it by itself. Noise of a path that is driven rolls the vehicle: none of that is asked
for; the changes of speed of a driver reach to 1 Hz."""

CLOSE, CORRECTIONS = {"speed": 0.0025, "lateral": 0.0004}, 6
"""m/s and m (rms) that a driver who is brought to the measured speed and path may miss them by, and how often at most he is
corrected for that. A millimetre of path once in 2 s is as much side acceleration as the noise of an instrument."""

ASTRAY, CORRECTED = {"speed": 0.01, "lateral": 0.003}, 2
"""m/s and m (rms) that a model may be off the speed and path of its driver before he is corrected while values are fitted, and how often
that is done."""

OF_FOOT = 0.2
"""Share of CLOSE and ASTRAY that a speed may be missed by where it is known by the accelerometer, of ASTRAY unless what is missing is made good
(``paced``): 0.5 mm/s at 1 Hz are 3 mm/s2."""

HELPED = 0.5
"""Share of what was missing that the right correction leaves at most."""

OVERHANG, BEYOND_AXLE = 4.0, 2.0
"""m at the ends of the road where one of the axles, or its contact, would leave it: beyond the front axle, where that is told, as many
as ``simulate.OVERHANG``."""

SPACING = 0.5
"""m between the points of the path that the simulator is given."""


@dataclass(frozen=True)
class Simulated:
    """What the model does at the measured instants: ``signals`` (6, time) in the order of SIGNALS, and the attitude ``roll``
    and ``pitch`` in rad."""

    signals: np.ndarray
    roll: np.ndarray
    pitch: np.ndarray
    source: tuple
    """What the signals were resampled from: arguments of ``sampling.resampled``."""

    @cached_property
    def slopes(self) -> np.ndarray:
        """Time derivatives of the signals, (6, time)."""
        return resampled_slopes(*self.source)[: len(SIGNALS)]


@dataclass(frozen=True)
class Following:
    """A ``replay``, and the ``run`` that its driver makes on its own clock; ``left_out``: quantities of which nothing counts as missing."""

    replay: Replay
    run: xr.Dataset
    left_out: tuple[str, ...] = ()

    @cached_property
    def simulated(self) -> Simulated:
        """The run at the measured instants."""
        return self.replay.sample(self.run)

    @cached_property
    def astray(self) -> dict[str, np.ndarray]:
        """By how much the run is astray (``Replay.astray``)."""
        found = self.replay.astray(self.run, lambda: self.simulated)
        return {name: missing for name, missing in found.items() if name not in self.left_out}

    def missed(self, name: str) -> float:
        """What is missing of speed (m/s) or path (m), rms; inf where that is not told."""
        return float(np.sqrt(np.mean(self.astray[name][self.replay.compared] ** 2))) if name in self.astray else np.inf

    def nearer(self, vehicle, effects=()) -> Following:
        """The same with its driver asked for what is missing."""
        again = self.replay.corrected(self.astray)
        return Following(again, again.run(vehicle, effects))

    def brought(
        self, vehicle, effects=(), allowed: Mapping[str, float] | None = None, corrections: int = CORRECTIONS
    ) -> Following:
        """The same with its driver corrected; arguments as for ``Replay.following``."""
        allowed, found = self.replay.strictly(CLOSE) if allowed is None else allowed, self
        for _ in range(corrections):
            if all(found.missed(name) < allowed[name] for name in found.astray):
                break
            nearer = found.nearer(vehicle, effects)
            helped = lambda one, share: one.missed("lateral") <= max(share * found.missed("lateral"), allowed["lateral"])
            if "lateral" in found.astray and not helped(nearer, HELPED):
                at_once = replace(found, replay=replace(found.replay, is_late=False))
                plainly = at_once.nearer(vehicle, effects) if found.replay.is_late else nearer
                if not helped(plainly, HELPED):
                    return nearer if helped(nearer, 1.0) else replace(found, left_out=("lateral",)).nearer(vehicle, effects)
                nearer = plainly
            found = nearer
        return found

    def residual(self) -> np.ndarray:
        """Simulated minus measured signals (``Replay.residual``), (6, time)."""
        return self.replay.residual(self.simulated)


@dataclass(frozen=True)
class Replay:
    """A measured drive, and the road and simulator that it is driven again with.

    ``compared`` marks the samples behind the run-in of the model.
    """

    drive: xr.Dataset
    road: object
    simulate: Callable[..., xr.Dataset]
    options: Mapping
    demand: Mapping
    time: np.ndarray
    place: np.ndarray
    compared: np.ndarray
    is_late: bool = True
    """Whether the driver comes to a path some time after it is asked for, as one who steers for a point ahead does."""
    kept_to: Mapping[str, np.ndarray] = field(default_factory=dict)
    """Speed ``v_x`` and path ``e`` that the driver is held to at the measured instants, (time,), if not to what was measured."""
    by_foot: tuple[float, float] | None = None
    """Hz from which and up to which the accelerometer tells what he does to the speed (``pedals.band``); else he is slow."""
    foot: np.ndarray | None = None
    """Acceleration (m/s2, (time,)) by which it told more than the model did before his foot was followed (``pedals.missing_acceleration``)."""
    by_chance: np.ndarray | float = 0.0
    """What of the missing speed (m/s, (time,)) within that band is likely to be its noise, and is not asked for (``pedals.without_noise``)."""
    is_foot_kept: bool = False
    """Whether that is held, too, where he is held to a speed."""

    def __call__(self, vehicle, effects=(), clock: float = 0.0) -> Simulated:
        """Simulate and sample at equal place; ``clock`` (s) shifts the inertial signals against place and speed by what alignment has not
        taken out. Raises InputError when the model does not arrive."""
        return self.sample(self.run(vehicle, effects), clock)

    def run(self, vehicle, effects=()) -> xr.Dataset:
        """The simulated drive on its own clock. Where the centre of gravity of ``vehicle`` lies elsewhere in the car than that which the drive is
        told of (``sensor.TOLD_OF``), the sensor stays at its place, and ``s`` is that of the same point."""
        demand = self.demand
        forward, up = displacement(self.drive.attrs, vehicle)
        if forward or up:
            x, y, z = demand["sensor"]
            demand = {**demand, "sensor": (x + forward, y, z + up), **{end: demand[end] - forward for end in ("start", "end")}}
        run = self.simulate(self.road, vehicle, effects=effects, **demand, **self.options)
        return run.assign(s=run["s"] + forward) if forward else run

    def sample(self, run: xr.Dataset, clock: float = 0.0) -> Simulated:
        """A simulated drive at the places where the vehicle was at the measured instants minus ``clock``."""
        place = np.interp(self.time - clock, self.time, self.place)
        recorded = run.variables
        travelled = np.maximum.accumulate(recorded["s"].values)
        goal = place[self.compared][-1]
        if not travelled[-1] >= goal - SPACING:
            raise InputError(
                f"the model stops at s = {travelled[-1]:.1f} m (expected to reach {goal:.1f} m)",
                place=f"drive {self.drive.attrs['name']}",
            )
        time = recorded["time"].values
        interval = float(time[1] - time[0])
        places = (np.interp(place, travelled, time) - time[0]) / interval
        values = np.stack([recorded[name].values for name in (*SIGNALS, "roll", "pitch")])
        source = (values, interval, places, float(self.drive.attrs["cut_off"]))
        found = resampled(*source)
        return Simulated(found[: len(SIGNALS)], found[-2], found[-1], source)

    def tuned(self, vehicle, effects=()) -> Replay:
        """The same, asking the model's driver for as much more or less as brings it to the measured speed and path.

        A driver model follows what it is asked for with a delay of its own; half a percent of speed is
        half a percent of every frequency.
        """
        return self.following(vehicle, effects).replay

    def following(
        self, vehicle, effects=(), allowed: Mapping[str, float] | None = None, corrections: int = CORRECTIONS
    ) -> Following:
        """The same with its driver corrected until he is off by less than is ``allowed`` (rms, by quantity; by default CLOSE, ``strictly``): so
        many times at most, and not on where that helps little.

        Before that, a correction for a driver who is not late is tried. Raises InputError when the model cannot be driven.
        """
        return Following(self, self.run(vehicle, effects)).brought(vehicle, effects, allowed, corrections)

    def strictly(self, allowed: Mapping[str, float]) -> Mapping[str, float]:
        """What a driver may miss (rms, by quantity) where this is ``allowed`` and the speed that he misses is not made good."""
        return allowed if self.by_foot is None else {**allowed, "speed": OF_FOOT * allowed["speed"]}

    def astray(self, run: xr.Dataset, sampled: Callable[[], Simulated] | None = None) -> dict[str, np.ndarray]:
        """By how much a simulated drive was too slow (m/s) and too far right (m) at the measured instants, as far as a driver is asked for it,
        (time,). ``sampled``: makes what ``sample`` does of the run.

        By the quantity that is asked for; one that was not measured, or that the simulator does not tell, is left out.
        """
        found, rate, driven = {}, rate_of(self.time), self.driven(run)
        for quantity, name in (("speed", "v_x"), ("lateral", "e")):
            missing = self.kept_to.get(name, self.drive.variables[name].values) - driven[name]
            if not np.isfinite(missing).all():
                continue
            if quantity == "lateral" or self.by_foot is None:
                found[quantity] = slowly(missing, rate, quantity)
            elif self.is_foot_kept and name in self.kept_to:
                found[quantity] = pedals.driven(missing, rate, self.by_foot)
            else:
                heard = pedals.missing_speed(self, sampled() if sampled else self.sample(run), missing, self.by_foot)
                found[quantity] = heard - self.by_chance
        return found

    def keeping(self, run: xr.Dataset, missed: np.ndarray | None = None) -> Replay:
        """The same with its driver held to what he drives in a ``run``, whatever the vehicle: ``following`` then corrects what another one does.
        With the speed (m/s, (time,)) that he ``missed`` by what is heard of his foot he is held to that, too; else every vehicle hears it anew, so
        that it is evidence for none."""
        driven, is_foot_kept = self.driven(run), self.by_foot is not None and missed is not None
        if is_foot_kept:
            driven["v_x"] = driven["v_x"] + missed
        return replace(self, kept_to=driven, is_foot_kept=is_foot_kept)

    @cached_property
    def left(self) -> np.ndarray | float:
        """By how much (m) the measured path lies to the left of the one that its driver is held to, slowly changing, (time,)."""
        held = self.kept_to.get("e")
        return 0.0 if held is None else slowly(self.drive["e"].values - held, rate_of(self.time), "lateral")

    def driven(self, run: xr.Dataset) -> dict[str, np.ndarray]:
        """Speed ``v_x`` and path ``e`` of a simulated drive at the places of the measured instants, (time,)."""
        travelled = np.maximum.accumulate(run.variables["s"].values)
        return {name: np.interp(self.place, travelled, run.variables[name].values) for name in ("v_x", "e")}

    def corrected(self, missing: Mapping[str, np.ndarray]) -> Replay:
        """The same, asking the driver for so much more speed (m/s), and for a path so much farther left (m), at the measured instants."""
        demand = dict(self.demand)
        u = demand["speed"]["u"].values
        for quantity, more in missing.items():
            if quantity == "lateral" and self.is_late:
                speed = np.interp(self.place, u, demand["speed"].values)
                more = path_demand(more, 1 / rate_of(self.time), speed)
            elif quantity == "speed" and self.by_foot is not None:
                more = speed_demand(more, 1 / rate_of(self.time))
            demand[quantity] = demand[quantity] + xr.DataArray(np.interp(u, self.place, more), {"u": u}, "u")
        return replace(self, demand=demand)

    def aside(self, vehicle, effects=(), step: float = 0.02) -> np.ndarray:
        """Change of the signals per metre that the path lies farther left, (6, time): a secant over ``step`` (m)."""
        left, right = (
            replace(self, demand={**self.demand, "lateral": self.demand["lateral"] + shift})(vehicle, effects).signals
            for shift in (0.5 * step, -0.5 * step)
        )
        return (left - right) / step

    def measured(self) -> np.ndarray:
        """The measured signals, (6, time), in the order of SIGNALS."""
        return self._measured.copy()

    @cached_property
    def _measured(self) -> np.ndarray:
        return np.stack([self.drive[name].values for name in SIGNALS])

    @cached_property
    def up(self) -> np.ndarray:
        """Unit vector that points up along the body's axes, as alignment has it, (3, time)."""
        return upward(self.drive["roll"].values, self.drive["pitch"].values)

    def residual(self, simulated: Simulated) -> np.ndarray:
        """Simulated minus measured signals, (6, time); NaN where they are not ``compared`` (eq:nonlinlsq).

        An accelerometer holds gravity, which alignment has taken out with an attitude of its
        own (``roll``, ``pitch`` of the drive). Specific force is compared with specific force:
        the attitude of this simulation replaces that one.
        """
        difference = simulated.signals - self._measured
        if self.drive.attrs.get("gravity", 0):
            difference[:3] += STANDARD_GRAVITY * (upward(simulated.roll, simulated.pitch) - self.up)
        difference[:, ~self.compared] = np.nan
        return difference


def replay(
    drive: xr.Dataset,
    road,
    simulate: Callable[..., xr.Dataset],
    *,
    lateral_correction: float = 0.0,
    margin: float = MARGIN,
    options: Mapping | None = None,
) -> Replay:
    """Prepare to drive ``drive`` again: the path and speed that the simulator is asked for.

    Speed over ``u`` is the measured v_x, low-passed (``speed_bandwidth``); the lateral position is what the driver must aim
    for to drive ``e`` where that was measured, else the drive's ``lateral_position`` (0 if unknown), plus
    ``lateral_correction`` (m). The model starts a run-in and ``margin`` (m) before the drive and ends ``margin`` behind
    it, road permitting. ``options`` go to the simulator as they are (step, effects_folder, ...), but for the rate. ``road``
    may be what ``simulate.prepare`` makes of one, which saves doing so in every run. Raises InputError when the drive leaves
    the road or stands.
    """
    options = dict(options or {})
    time = drive["time"].values
    rate = rate_of(time)
    speed = smooth(drive["v_x"].values, rate, speed_bandwidth(drive["v_x"].values, rate))
    surface = getattr(road, "road", road)
    place = fused_place(drive, rate, surface)
    label = f"drive {drive.attrs['name']}"
    if len(time) < 3 * rate:
        raise InputError(f"lasts {len(time) / rate:.2f} s (expected at least 3 s)", place=label)
    first_s, last_s = (float(drive["s"][i]) for i in (0, -1))
    if last_s < first_s:
        raise InputError(
            f"s falls from {first_s:.1f} to {last_s:.1f} m: driven against the reference line, which is not supported "
            "(expected s that rises)",
            place=label,
        )
    advance = np.gradient(place, time)
    slow = np.flatnonzero((speed < SLOWEST) | (advance < 0.3 * SLOWEST))
    if slow.size:
        i, begin = slow[0], float(drive.attrs.get("start_time", 0.0))
        by_speed = f"{speed[i]:.2f} m/s by {'s' if DIFFERENTIATED in drive.attrs.get('treatment', '') else 'v_x'}"
        found = by_speed if speed[i] < SLOWEST else f"{advance[i]:.2f} m/s by s, {by_speed}"
        raise InputError(f"{found} at {round(begin + time[i], 2) + 0.0:.2f} s (expected above {SLOWEST:g} m/s throughout: cut the record)", place=label)
    first, last = float(surface["u"][0]), float(surface["u"][-1])
    if place[0] < first - SPACING or place[-1] > last + SPACING:
        raise InputError(
            f"its centre of gravity runs from s = {place[0]:.1f} to {place[-1]:.1f} m{'' if drive.attrs.get('place_measured', 1) else ' by v_x'} "
            f"(expected within the road, {first:.1f} to {last:.1f} m)",
            place=label,
        )
    start, end = max(first, place[0] - RUN_IN - margin), min(last, place[-1] + margin)
    u = np.linspace(start, end, max(2, int(np.ceil((end - start) / SPACING)) + 1))
    lateral = np.nan_to_num(float(drive.attrs.get("lateral_position", 0.0))) + lateral_correction
    if np.isfinite(drive["e"].values).all():
        offset = path_demand(slowly(drive["e"].values, rate), 1 / rate, speed)
        lateral = xr.DataArray(np.interp(u, place, offset + lateral_correction), {"u": u}, "u")
    demand = {
        "speed": xr.DataArray(_continued(u, place, speed, rate), {"u": u}, "u"),
        "lateral": lateral,
        "friction": float(drive.attrs.get("road_friction", 1.0)),
        "start": start,
        "end": end,
        "sensor": tuple(float(drive.attrs[f"sensor_{axis}"]) for axis in "xyz"),
    }
    ahead = max(OVERHANG, float(drive.attrs.get("cg_to_front_axle", 0.0)) + BEYOND_AXLE)
    compared = (place >= max(start, first + OVERHANG) + RUN_IN) & (place <= last - ahead)
    if not compared.any():
        raise InputError(
            f"nothing is left of s = {place[0]:.1f} to {place[-1]:.1f} m after a run-in of {RUN_IN:g} m", place=label
        )
    step = float(options.get("step", INTERVAL))
    rate_of_model = 1 / (step * max(1, np.ceil(INTERVAL / step - 1e-9)))
    return Replay(drive, road, simulate, {**options, "rate": rate_of_model}, demand, time, place, compared)


def _continued(u: np.ndarray, place: np.ndarray, speed: np.ndarray, rate: float) -> np.ndarray:
    """Speed over u; before and behind the drive it goes on changing as in the first and last second.

    A driver model that starts at the speed but without the acceleration needs seconds to find it.
    """
    second = max(1, int(rate))
    before = (speed[second] - speed[0]) / (place[second] - place[0])
    behind = (speed[-1] - speed[-1 - second]) / (place[-1] - place[-1 - second])
    target = np.interp(u, place, speed)
    target += np.minimum(u - place[0], 0.0) * before + np.maximum(u - place[-1], 0.0) * behind
    return np.clip(target, max(0.8 * speed.min(), SLOWEST), 1.2 * speed.max())


def slowly(values: np.ndarray, rate: float, quantity: str = "lateral") -> np.ndarray:
    """What a driver model's delay is made up for: little of it is faster than DELAY_BANDWIDTH."""
    return smooth(values, rate, DELAY_BANDWIDTH, order=DELAY_ORDERS[quantity])


def fused_place(drive: xr.Dataset, rate: float, road: xr.Dataset) -> np.ndarray:
    """Distance along the reference line in m: slow changes as measured, fast ones from the speed.

    A jitter of s by 5 mm would be a jitter of the comparison by 0.2 ms at 25 m/s. In a bend of the ``road`` a
    vehicle to the left of the line passes more of it than it drives.
    """
    aside = np.nan_to_num(drive["e"].values)
    curvature = np.interp(drive["s"].values, road["u"].values, road["curvature"].values)
    speed = drive["v_x"].values / (1 - curvature * smooth(aside, rate))
    travelled = integral(speed, drive["time"].values)
    return travelled + smooth(drive["s"].values - travelled, rate, bandwidth=0.2)
