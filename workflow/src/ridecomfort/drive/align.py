"""What stands between a record and the road: clock, speed scale, path, mounting, gain and bias.

Each is found against a simulation, from what a wrong vehicle cannot imitate: gain and
tilt from gravity, the speed scale from distance, the path from the roughness that it
meets. The clock it can (a wrong damping turns phases, too), so a provisional vehicle is
fitted along with it, drive by drive, and thrown away. So can an effect that the vehicle lacks: a
soft top mount passes for 2 ms, and a model that has it is compared with drives aligned for it. A driver's foot is heard
where the accelerometer tells it (``pedals``): of one who is followed too slowly the error hides the path.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..errors import InputError
from ..vocabulary import SIGNALS
from . import axes, configured, mounting, path, pedals, place, signs, turning
from .distance import DIFFERENTIATED
from .record import acceleration, completed, felt
from .replay import Following, Simulated, replay

PASSES, MOST = 3, 15
"""Rounds of vehicle, mounting, clock and path: so many at least (three more change the clock by 0.2 ms on the stand-in drives) and at most."""

SETTLED = 0.02
"""m (rms) along or across the road that the last round may move a drive by. The third moves one whose s wanders by 0.3 m by 7 cm, and that of a
multi-body car, whose s is right, by 1 cm as every other would: the clock goes on by milliseconds there, so it does not count."""

STEADY = 0.003
"""rad that the last round may turn an instrument by: one and a half times what is usually left of a mounting (``mounting.LEFT``). The third
turns one that sits right by a sixth of that at most, and one that is turned by 20 deg by 0.026 still."""

LOWEST = 0.3
"""Correlation (rms over ``place.SHAKEN``) below which a record is none of a drive on this road: with a nominal vehicle a drive has
0.75 to 0.98, one at a wrong place or path up to 0.3."""

TIMES = 8.0
"""Times by which the rms of a signal may differ from the model's before another unit is likely: a rate in deg/s is 57 times one in rad/s, an
acceleration in g a tenth of one in m/s2."""

CLOSE = 0.02
"""s by which two ways to find the clock may differ."""

OFF, DRIFT = 0.003, 1.0
"""Share, and m in all, beyond which a recorded distance that the road finds too long or too short is an odometer's: a receiver's is good to some
metres wherever it is, and drives of 20 s tell a share to 0.001."""


class PlaceNotFound(InputError):
    """A drive agrees with the model nowhere near its place, or only at a clock beyond what is searched."""


def align(
    drive: xr.Dataset,
    road,
    vehicle,
    *,
    simulate: Callable[..., xr.Dataset],
    effects: Mapping[str, Mapping[str, float]] | None = None,
    search: float = 0.5,
    options: Mapping | None = None,
) -> xr.Dataset:
    """The drive brought into line with the road, gravity removed, and what was found as attributes.

    ``drive`` is a record (``drive.record``), ``road`` a road or a prepared one (``simulate.prepare``),
    ``vehicle`` the one to begin from (it need not fit), driven with ``effects``; ``simulate`` has the signature of ``simulate.run``
    and ``search`` (s) bounds the clock offset. A place that was integrated from speed is that on the road after so much way,
    but for a scale and an offset. What lies off the road only because of these, of the clock or since ``s`` was told of the front axle is cut off. Place and speed are moved onto the clock of the inertial signals (they are smooth, so nothing is lost between samples); signals are freed of
    gain, mounting and bias; ``e`` becomes the path that was found.

    New in the attribute ``faults``: a recorded distance that is an odometer's, a place that does not settle, an instrument that is turned, signals of
    the wrong sign, turning without a bend. New attributes: clock_offset with clock_offset_error (s), speed_scale, distance_offset (m),
    lateral_correction (m), distance_wander and lateral_wander (m, rms of what was found of both
    along the drive), mounting_roll/pitch/yaw (rad), acceleration_gain, yaw_rate_gain (against the bends of
    the road; nan where it hardly bends), roll/pitch/yaw_rate_bias (rad/s). New variables ``roll`` and ``pitch`` (rad): the
    simulated attitude that gravity was taken out with; zero where the record held none. Raises InputError when the model cannot
    drive where the record says it went or that is off the road, when clock or path lie at an end of what is searched or beyond, and
    when model and record do not agree anywhere.
    """
    options, simulate = options or {}, _with(simulate, effects or {})
    (drive,) = completed([drive])
    path.require_on_road(drive, road)
    work = mounting.level(drive)
    measured, start = bool(drive.attrs["place_measured"]), float(drive["s"][0])
    way = place.way(work, road, start)
    if measured:
        scale, offset = place.speed_scale(work, way), 0.0
        if scale > 0.0 and (said := configured.speed_words(scale)):  # a model that is driven at such a speed would only be told to be slow, or late
            raise InputError(said, place="v_x")
        work = place.moved(work, scale=scale)
        work = place.cut(work, place.on_road(work, road, before=float(drive.attrs.get("cg_to_front_axle", 0.0)), behind=0.0))
        wrong = signs.against(work, road, vehicle, simulate, options)
        work = signs.reversed_in(work, wrong)
    else:
        lasts = float(work["time"][-1])
        if lasts < place.SHORTEST:
            raise InputError(
                f"lasts {lasts:.4g} s (expected at least {place.SHORTEST:g} s where s is left out, by which its place and speed are found on the road)",
                place=f"drive {drive.attrs['name']}",
            )
        work, kept, scale, offset, wrong = _by_speed(work, way, road, vehicle, simulate, options)
        drive = place.cut(drive, kept)
    error, fitted, turned = np.nan, mounting.Mounting(), 0.0
    try:
        found = _found(work, road, vehicle, simulate, search, options)
    except PlaceNotFound as problem:
        raise (_of_an_odometer(problem, work, way, road, vehicle, simulate, search, options) if measured else problem) from None
    work, clock, lateral = found
    work, lateral, on_the_other_side = path.mirrored(work, road, vehicle, simulate, options, lateral)
    work = _where_recorded(work, clock) if measured else work
    work = _on_path(work, lateral)
    exchanged, doubt = "", _odometer(work, way, road, vehicle, simulate, options)[0] if measured else ""
    expected = path.EXPECTED_ASIDE_MEASURED if path.has_offset(drive) else path.EXPECTED_ASIDE
    if not measured:  # along another path the way is another
        way = place.way(work, road, start)
        scale, offset = map(float, np.polyfit(drive["s"].values, way(work["s"].values), 1))
        work = place.driven(work, drive, way, scale, offset)
    moved_along, moved_aside = np.zeros(work.sizes["time"]), np.zeros(work.sizes["time"])
    asked = lambda: replay(work, road, simulate, options=options)
    for done in range(1, MOST + 1):
        heard = pedals.listening(asked(), vehicle)
        again, simulated, by_foot = heard.replay, heard.simulated, heard.replay.by_foot
        if done == 1:  # of a drive at its place whose instrument nothing has turned yet
            exchanged = axes.words(again, simulated)
        if drive.attrs["gravity"]:
            turn = mounting.fit(again, simulated)
            work, fitted, turned = mounting.corrected(work, turn), fitted.then(turn), float(np.max(np.abs(turn.rotation)))
            again = replace(again, drive=work)
        step, error, better = place.clock(again, simulated, vehicle)
        if measured:
            clock += step
            work = place.moved(work, clock=step)
        else:
            step_scale, step_offset = place.refine(again, simulated, way)
            scale, offset = scale * step_scale, offset * step_scale + step_offset
            work = place.driven(work, drive, way, scale, offset)
            work = work.assign(s=work["s"] + moved_along)
        brought = replace(asked(), by_foot=by_foot).following(vehicle)
        vehicle, simulated = _better(vehicle, better, brought)
        along, aside = path.wander(brought.replay, simulated, vehicle, expected)
        work = work.assign(s=work["s"] + along, e=work["e"] + aside)
        moved_along, moved_aside = moved_along + along, moved_aside + aside
        last = [float(np.sqrt(np.mean(moved**2))) for moved in (along, aside)]
        if done >= PASSES and (exchanged or doubt or max(last) < SETTLED and turned < STEADY):  # what is to be told otherwise need not settle
            break
    brought = replace(asked(), by_foot=by_foot).following(vehicle)
    aligned, tilt = _without_gravity(work, brought.simulated), mounting.words(fitted)
    if not drive.attrs["gravity"]:
        tilt = mounting.words_not_turned_back(brought.replay, brought.simulated)
    told = exchanged or "; ".join(filter(None, (doubt or _unsettled(drive, last, turned), tilt)))
    told = "; ".join(filter(None, (signs.words(wrong), on_the_other_side, turning.without_bends(aligned, getattr(road, "road", road)), told)))
    aligned.attrs.update(
        lateral_position=float(work["e"].mean()),
        clock_offset=float(clock),
        clock_offset_error=float(error),
        speed_scale=float(scale),
        distance_offset=0.0 if measured else float(way.place(offset)),
        lateral_correction=float(lateral),
        distance_wander=float(moved_along.std()),
        lateral_wander=float(moved_aside.std()),
        faults="; ".join(filter(None, (drive.attrs.get("faults", ""), told))),
        yaw_rate_gain=turning.gyroscope_gain(aligned, getattr(road, "road", road))[0],
        **fitted.attributes(),
    )
    return signs.reversed_in(aligned, wrong)


def _by_speed(
    work: xr.Dataset, way: place.Way, road, vehicle, simulate, options: Mapping
) -> tuple[xr.Dataset, np.ndarray, float, float, dict[str, float]]:
    """The drive where its way, integrated from speed, lies on the road, with signals of the right sign; which of its samples these are, the scale
    and offset (m) of that way, and the signals that were of the wrong sign, with their correlations (``signs.against``).

    The odometer listens to all signals, and some are only known to run against the model where it found the drive: it is asked again then.
    """
    near = lambda one: place.on_road(one, road, place.ODOMETER_REACH, place.ODOMETER_REACH)
    wrong = signs.against(place.cut(work, place.on_road(work, road)), road, vehicle, simulate, options)
    right = signs.reversed_in(work, wrong)
    while True:
        scale, offset = place.odometer(right, way, road, vehicle, simulate, options)
        placed = place.driven(right, work, way, scale, offset)
        kept = near(placed)
        heard = signs.against(place.cut(placed, kept), road, vehicle, simulate, options)
        more = {name: own for name, own in heard.items() if name not in wrong}
        if not more:
            return place.cut(placed, kept), kept, scale, offset, wrong
        wrong, right = {**wrong, **more}, signs.reversed_in(right, list(more))


def _odometer(work: xr.Dataset, way: place.Way, road, vehicle, simulate, options: Mapping) -> tuple[str, xr.Dataset]:
    """Words on a recorded distance that runs faster or slower than the road goes by, empty where it does not, and the drive where the road has it."""
    driven = work.assign(s=work["s"].copy(data=way(work["s"].values)))
    scale, offset = place.odometer(driven, way, road, vehicle, simulate, options)
    placed, too_far = place.driven(driven, driven, way, scale, offset), 1.0 / scale - 1.0
    if abs(too_far) < max(OFF, DRIFT / float(np.ptp(work["s"].values))):
        return "", placed
    if not _agrees(placed, road, vehicle, simulate, options) > _agrees(work, road, vehicle, simulate, options):
        return "", placed
    where, start = "far" if too_far > 0 else "short", float(placed["s"][0]) - float(placed.attrs.get("way_before", 0.0))
    instead = f"{_instead_of_s(work)}, with distance_start: {start:.0f}: it is then integrated from v_x and scaled"
    return f"s: runs {100 * abs(too_far):.1f} % too {where} over the road, as that of an odometer ({instead})", placed


def _agrees(work: xr.Dataset, road, vehicle, simulate, options: Mapping) -> float:
    """How well a drive agrees with the road where it is (``place.shaken`` at lags within CLOSE); -inf where it cannot be driven."""
    try:
        again = replay(place.cut(work, place.on_road(work, road)), road, simulate, options=options)
        return float(place.shaken(again, again(vehicle), CLOSE)[1].max())
    except InputError:
        return -np.inf


def _instead_of_s(work: xr.Dataset) -> str:
    """What to tell in place of an ``s`` that is not good enough, which may be all that was told of the speed."""
    return "give its slope as v_x in its place" if DIFFERENTIATED in work.attrs["treatment"] else "leave s out"


def _of_an_odometer(problem: PlaceNotFound, work: xr.Dataset, way: place.Way, road, vehicle, simulate, search: float, options: Mapping) -> InputError:
    """The ``problem`` with a drive, behind the words on its odometer where it is found on the road with these."""
    try:
        words, placed = _odometer(work, way, road, vehicle, simulate, options)
        if words:
            _found(place.cut(placed, place.on_road(placed, road)), road, vehicle, simulate, search, options)
    except InputError:
        return problem
    label = f"drive {work.attrs['name']}"
    return InputError(f"{words}; if not, {str(problem).removeprefix(f'{label}: ')}", place=label) if words else problem


def _unsettled(drive: xr.Dataset, last: Sequence[float], turned: float) -> str:
    """Words on m (rms) that the ``last`` round moved a ``drive`` by along and across the road, and on the rad by which it ``turned`` the
    instrument; empty where that is little."""
    said, asked = [], []
    if max(last) >= SETTLED:
        said.append(f"moved the place by {last[0]:.2f} m along and {last[1]:.2f} m across the road")
    if last[0] >= SETTLED:
        instead = f"{_instead_of_s(drive)}, with distance_start: it is then integrated from v_x"
        asked.append(f"is s good to 0.5 m (if not, {instead})" if drive.attrs["place_measured"] else "is v_x right")
    if last[1] >= SETTLED:
        asked.append("is e right, its unit, too" if path.has_offset(drive) else "was it driven parallel to the reference line (if not, record e)")
    if turned >= STEADY:
        said.append(f"turned the instrument by {np.degrees(turned):.1f} deg")
        asked.append("are the axes of accelerations and rates right")
    return f"alignment does not settle: its last round {' and '.join(said)}: {', '.join(asked)}?" if said else ""


def _moved_on_road(work: xr.Dataset, road, clock: float) -> xr.Dataset:
    """The drive moved by a ``clock`` (s) without what that moves off the road."""
    work = place.moved(work, clock=clock)
    return place.cut(work, place.on_road(work, road))


def _where_recorded(work: xr.Dataset, clock: float) -> xr.Dataset:
    """The drive where its place and speed were recorded, whose ``clock`` (s) was off: farther than ``place.END`` beyond, they would only be
    continued."""
    time = work["time"].values
    return place.cut(work, (time - clock >= time[0] - place.END) & (time - clock <= time[-1] + place.END))


def _with(simulate: Callable[..., xr.Dataset], own: Mapping) -> Callable[..., xr.Dataset]:
    """The simulator with effects of its own, whichever it is called with."""

    def run(road, vehicle, effects=(), **settings) -> xr.Dataset:
        return simulate(road, vehicle, effects=own, **settings)

    return run


def _found(work: xr.Dataset, road, vehicle, simulate, search: float, options: Mapping) -> tuple[xr.Dataset, float, float]:
    """The drive moved by its clock to a sample, this clock (s), and its path, m to the left of the recorded one.

    A path that is known is looked for at the clock that fits it. One that is not, or does not agree, is looked for all across the
    road together with the clock. Raises InputError where either lies at an end of what is searched or beyond, and where nothing agrees.
    """
    measured, known, clock, lateral = bool(work.attrs["place_measured"]), path.is_known(work), 0.0, 0.0
    if measured:
        again = replay(work, road, simulate, options=options)
        clock = place.coarse_clock(again, again(vehicle), search)
        work = _moved_on_road(work, road, clock)
    reach = max(search - 0.5 * float(work["time"][1] - work["time"][0]), 0.0)  # a clock at the last lag of the search may lie beyond it
    look = dict(clock=clock, reach=reach)
    if known:
        lateral = path.find_offset(work, road, vehicle, simulate, options)
        _, lag, agreement = path.search(work, road, vehicle, simulate, options, tried=[lateral], **look)
        if agreement >= LOWEST**2 and abs(lag) <= CLOSE and abs(clock) <= reach and not path.is_at_an_end(work, road, lateral):
            return work, clock, lateral
    around, lag, agreement = path.search(work, road, vehicle, simulate, options, **look)
    label = f"drive {work.attrs['name']}"
    begins = "are s and the axes right" if measured else "are the axes and signs right, and distance_start (0 m unless given) to 15 m"
    if agreement < LOWEST**2:
        raise PlaceNotFound(
            f"model and record agree nowhere near this place: {', '.join(place.SHAKEN)} correlate by "
            f"{np.sqrt(max(agreement, 0)):.2f} at best "
            f"(expected {LOWEST:g} or more; is it the road of this drive, {begins}? Where the path is known, "
            f"lateral_position says so){_otherwise(work, road, vehicle, simulate, options)}",
            place=label,
        )
    if measured and abs(lag) > CLOSE:
        clock, work = clock + lag, _moved_on_road(work, road, lag)
    if abs(clock) > reach:
        raise PlaceNotFound(
            f"the inertial signals lag {clock:.3g} s behind s (expected within {search:g} s, `alignment: search` of the study: "
            "make it wider, or move s, v_x and e, all of them, in the table by as much; does s begin where the road's does?)",
            place=label,
        )
    lateral = path.find_offset(work, road, vehicle, simulate, options, around=around)
    if path.is_at_an_end(work, road, lateral):
        right, left = path.ends(work, road)
        is_mirrored = path.has_offset(work) and abs(2.0 * float(work["e"].mean()) + lateral) < path.STEP
        sign = "; with the other sign e would lie there: is it positive to the left?" if is_mirrored else ""
        raise InputError(
            f"its path fits the road best {lateral:+.2f} m to the left of {'what is recorded or told' if known else 'the reference line'}, "
            f"at an end of what is searched or beyond (expected between {right:+.2f} and {left:+.2f} m; is lateral_position or e right, "
            f"is the road as wide as the drive?){sign}{_otherwise(work, road, vehicle, simulate, options)}",
            place=label,
        )
    return work, clock, lateral


def _otherwise(work: xr.Dataset, road, vehicle, simulate, options: Mapping) -> str:
    """Words on what the road shakes if it is so much larger or smaller than the model's that its unit may be another, and on axes that are
    exchanged; empty where neither is."""
    again = replay(work, road, simulate, options=options)
    simulated = again(vehicle)
    measured, modelled = (each[:, again.compared].std(axis=1) for each in (again.measured(), simulated.signals))
    times = dict(zip(SIGNALS, measured / np.maximum(modelled, 1e-12)))
    far = {name: times[name] for name in place.SHAKEN if not 1.0 / TIMES < times[name] < TIMES}
    said = [f"{name} is {found:.2g} times what the model does: is its unit right?" for name, found in far.items()]
    exchanged = axes.words(again, simulated) or axes.columns(again, simulated)
    return "".join(f"; {words}" for words in (*said, exchanged) if words)


def _better(vehicle, values: Mapping[str, float], brought: Following) -> tuple[object, Simulated]:
    """The vehicle with these values if it brings the model closer to the drive than as it was when its driver was ``brought`` there, else as it
    was, and what it does."""
    again, as_it_was = brought.replay, brought.simulated
    try:
        changed = vehicle.replace(**values)
        simulated = again(changed)
    except ValueError:  # beyond what is plausible, or the drive cannot be driven
        return vehicle, as_it_was
    return (changed, simulated) if place.misfit(again, simulated) < place.misfit(again, as_it_was) else (vehicle, as_it_was)


def _on_path(work: xr.Dataset, lateral: float) -> xr.Dataset:
    """The drive with e on its recorded or known path, moved to the left by ``lateral`` (m)."""
    if path.has_offset(work):
        return work.assign(e=work["e"] + lateral)
    constant = np.nan_to_num(work.attrs["lateral_position"]) + lateral
    return work.assign(e=xr.full_like(work["e"], constant))


def _without_gravity(work: xr.Dataset, simulated: Simulated) -> xr.Dataset:
    aligned = work.copy()
    if work.attrs["gravity"]:
        force = felt(work)
        for name, values in zip(SIGNALS[:3], acceleration(force, simulated.roll, simulated.pitch)):
            aligned[name] = work[name].copy(data=values)
        aligned["roll"] = "time", simulated.roll
        aligned["pitch"] = "time", simulated.pitch
    return aligned
