"""The compiled vehicle: 14 degrees of freedom, the driver, and the road under four wheels.

``reference.py`` holds the same model as plain NumPy and explains it; this file is its
fast form. Arrays are ordered as in ``motion`` (pose, speeds) and ``constants`` (wheels:
front left, front right, rear left, rear right). ``change`` holds the time derivatives of
``speeds``, ``now`` the speeds at the same instant as the pose.

Forces are evaluated once a step in a leapfrog scheme: positions at full steps, speeds
half a step later and extrapolated to the full step where forces depend on them, the
damping of the wheels taken implicitly. Second order, and symplectic where nothing dissipates.

What is reckoned for each wheel stands in loops of its own, without what effects add between them: the
compiler then reckons all four wheels at once.

Ports for further physics come from a module of the form of ``effects.neutral``;
``effects.compose`` makes a copy of this file for each set of effects in use.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ridecomfort.effects.neutral import (
    body_port,
    drive_port,
    flexing_port,
    interconnection_port,
    kinematics_port,
    road_port,
    steer_port,
    suspension_port,
    tyre_planar_port,
    tyre_vertical_port,
)
from ridecomfort.vehicle.constants import (
    ANTI_ROLL,
    DAMPING,
    MASS,
    OVERTURNING,
    ROLL_ARM,
    ROLL_CENTRE,
    SCRUB,
    SPRING,
    STATIC_DEFLECTION,
    STATIC_FORCE,
    X,
    Y,
)
from ridecomfort.vehicle.driver import SPEED_INTEGRAL_GAIN, locate, speed_control, steering, target_at
from ridecomfort.vehicle.ground import height, plane_slopes
from ridecomfort.vehicle.motion import (
    CURVATURE,
    HEADING,
    LATERAL,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    SPEED,
    V_X,
    V_Y,
    V_Z,
    YAW_RATE,
    BodyMotion,
    E,
    S,
    Z,
    body_course,
    body_rates,
    sensor_acceleration,
    sin_cos,
)
from ridecomfort.vehicle.scratch import zeros
from ridecomfort.vehicle.tyre import brush
from ridecomfort.vocabulary import STANDARD_GRAVITY

MINIMUM_SPEED = 1.0
"""m/s below which slips are no longer divided by the speed."""

STANDSTILL = 0.3
"""m/s at which a drive ends, wherever it is."""

CONTACT_DEPTH = 0.005
"""m of deflection over which the radial damping of a tyre builds up with its contact; it has
none at touch-down, so that the load does not jump (Hunt and Crossley 1975, J. Appl. Mech. 42)."""

PER_CONTACT_DEPTH = 1.0 / CONTACT_DEPTH

PROBE = 1e-6
"""A slip so small that the change of what a tyre answers to is in proportion."""

GRADE_LENGTH = 20.0
"""m of road whose grade the speed controller knows of at the start."""


@njit(cache=True, nogil=True)
def drive(
    car, wheels, surface, elevation, targets, friction, start, end, step, every, sensor,
    parameters, state_count, record, sensed,
):  # fmt: skip
    """Drive along the road; the number of records and of steps made.

    ``car``, ``wheels``: of ``constants``. ``surface``: Surface, ``elevation``: its heights.
    ``targets``: what the driver aims for on the u of the surface, shape (u, 3). ``friction``:
    of the road. ``start``, ``end``: m along the reference line. ``step``: s. ``every``: steps
    between records. ``sensor``: its place in m relative to the centre of gravity.
    ``parameters``, ``state_count``: of the effects. Filled: ``record`` (records, COLUMNS), all
    but what is SENSED, and ``sensed`` (6, steps): accelerations and rates of the sensor at every step.
    """
    states = np.zeros((4, state_count))
    return _drive(
        car, wheels, surface, elevation, targets, friction * car.tyre_friction, start, end, step, every,
        sensor, parameters, record, sensed, states[0], states[1], states[2], states[3],
    )  # fmt: skip


# Without reference counts on the arrays, which would cost as much as the physics: nothing is allocated on the heap here.
# Products and sums may be fused, which rounds once instead of twice, and regrouped, which shortens what waits for what.
@njit(error_model="numpy", _nrt=False, fastmath={"contract", "arcp", "reassoc", "nsz"})
def _drive(
    car, wheels, surface, elevation, targets, friction, start, end, step, every,
    sensor, parameters, record, sensed, states, slopes, slopes_before, slopes_earlier,
):  # fmt: skip
    felt, rates = zeros(3), zeros(3)
    pose, pose_rate, speeds, change, now = zeros(6), zeros(3), zeros(6), zeros(6), zeros(6)
    wheel_z, wheel_v, wheel_change, spin, spin_change, rotation = zeros(4), zeros(4), zeros(4), zeros(4), zeros(4), zeros(4)
    force_x, force_y, load, torque, suspension = zeros(4), zeros(4), zeros(4), zeros(4), zeros(4)
    travel_rate, recession, toe, scrub, fore_push, side_push = zeros(4), zeros(4), zeros(4), zeros(4), zeros(4), zeros(4)
    gripped, fore, spin_changed = zeros(4), zeros(4), zeros(4)
    ground, before, surging = zeros(4, 4), zeros(6), zeros(6)
    half = 0.5 * step
    _settle(
        car, wheels, surface, elevation, targets, start, step, parameters, states, slopes,
        pose, pose_rate, speeds, wheel_z, wheel_v, spin, rotation, ground,
    )  # fmt: skip
    rise = 0.0
    for end_of_rise, side in ((start, -1.0), (start + GRADE_LENGTH, 1.0)):
        level = height(surface, elevation, end_of_rise, pose[E])
        rise += side * (level + road_port(0, end_of_rise, pose[E], level, 0.0, surface, elevation, parameters, states, slopes))
    integral = STANDARD_GRAVITY * rise / (GRADE_LENGTH * SPEED_INTEGRAL_GAIN)

    records, steps = 0, 0
    room = min(record.shape[0] * every, sensed.shape[1])
    while pose[S] < end and speeds[V_X] > STANDSTILL and steps < room:
        for k in range(6):
            now[k] = speeds[k] + half * change[k]
        index, fraction = locate(surface, targets, pose[S])
        curvature = target_at(targets, index, fraction, CURVATURE)
        pace = max(now[V_X], MINIMUM_SPEED)

        demand, integral = speed_control(
            car, surface, targets, index, fraction, pose[S], now[V_X], pace, integral, step
        )
        demand = drive_port(demand, now[V_X], parameters, states, slopes)
        course = pose[HEADING] + now[V_Y] / pace
        lateral = target_at(targets, index, fraction, LATERAL)
        angle = steering(pose[E], course, pace, lateral, curvature, car.wheelbase)
        angle = steer_port(angle, now[V_X], force_y[0] + force_y[1], parameters, states, slopes)

        _feel(
            wheels, surface, elevation, pose, pose_rate, curvature, step, spin, rotation, parameters, states, slopes, ground
        )
        slope_x, slope_y = plane_slopes(car, ground[1])
        # The acceleration of the body, carried on: that of the step before would make wheels on soft bushings swing.
        for k in range(6):
            surging[k] = 2.0 * change[k] - before[k]
            before[k] = change[k]
        _vertical(
            car, wheels, pose, now, change, slope_y, wheel_z, wheel_v, wheel_change, spin, rotation, ground, step,
            force_x, force_y, fore_push, side_push, parameters, states, slopes, load, suspension, travel_rate,
            recession, toe, scrub,
        )  # fmt: skip
        _planar(
            car, wheels, now, surging, travel_rate, recession, toe, scrub, ground, slope_x, load, spin, spin_change, rotation, angle, demand,
            friction, step, parameters, states, slopes, torque, force_x, force_y, side_push, gripped, spin_changed,
        )  # fmt: skip
        flex_x, flex_y, flex_z = _accelerate(
            car, wheels, pose, now, surging, slope_x, slope_y, change, wheel_change, recession, scrub, load, force_x, force_y, torque,
            suspension, fore, fore_push, side_push, sensor, parameters, states, slopes,
        )  # fmt: skip

        sensor_acceleration(felt, sensor, pose, now, change)
        body_rates(rates, pose, now)
        sensed[0, steps] = felt[0] + flex_x
        sensed[1, steps] = felt[1] + flex_y
        sensed[2, steps] = felt[2] + flex_z
        sensed[3, steps] = rates[0]
        sensed[4, steps] = rates[1]
        sensed[5, steps] = rates[2]
        if steps % every == 0:
            body_course(record[records], pose, now)
            records += 1
        steps += 1

        for i in range(4):
            wheel_v[i] += step * wheel_change[i]
            wheel_z[i] += step * wheel_v[i]
        index, fraction = locate(surface, targets, pose[S] + half * pose_rate[0])
        _advance(step, target_at(targets, index, fraction, CURVATURE), pose, pose_rate, speeds, change)
        for k in range(len(states)):
            states[k] += step * (23.0 * slopes[k] - 16.0 * slopes_before[k] + 5.0 * slopes_earlier[k]) / 12.0
            slopes_earlier[k] = slopes_before[k]
            slopes_before[k] = slopes[k]
    return records, steps


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _settle(
    car, wheels, surface, elevation, targets, start, step, parameters, states, slopes,
    pose, pose_rate, speeds, wheel_z, wheel_v, spin, rotation, ground,
):  # fmt: skip
    """Begin at rest on the springs, moving along the plane under the wheels."""
    index, fraction = locate(surface, targets, start)
    curvature = target_at(targets, index, fraction, CURVATURE)
    speed = target_at(targets, index, fraction, SPEED)
    pose[S], pose[E] = start, target_at(targets, index, fraction, LATERAL)
    pose_rate[0] = speed
    for back in range(3, 0, -1):
        pose[S] = start - back * step * speed
        _feel(
            wheels, surface, elevation, pose, pose_rate, curvature, step, spin, rotation, parameters, states, slopes, ground
        )
    pose[S] = start
    slope_x, slope_y = plane_slopes(car, ground[0])
    middle = 0.0
    for i in range(4):
        middle += 0.25 * (ground[0, i] - wheels[X, i] * slope_x - wheels[Y, i] * slope_y)
    pose[Z], pose[ROLL], pose[PITCH] = middle + car.cg_height, slope_y, -slope_x
    speeds[V_X], speeds[YAW_RATE], speeds[V_Z] = speed, curvature * speed, slope_x * speed
    for i in range(4):
        plane = middle + wheels[X, i] * slope_x + wheels[Y, i] * slope_y
        wheel_z[i] = plane + car.tyre_radius - wheels[STATIC_DEFLECTION, i]
        wheel_v[i] = slope_x * speed
        spin[i] = speed / car.tyre_radius


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _feel(
    wheels, surface, elevation, pose, pose_rate, curvature, step, spin, rotation, parameters, states, slopes, ground
):
    """Shift the heights under the wheels by a step and look up those one step ahead.

    Rows of ``ground``: one step ahead, now, one and two steps before. The bend of the road
    enters the place of a wheel to second order; ``stretch`` is the series of 1 / (1 - bend).
    """
    sine, cosine = sin_cos(pose[HEADING] + step * pose_rate[2])
    s = pose[S] + step * pose_rate[0]
    e = pose[E] + step * pose_rate[1]
    u, v, turn = zeros(4), zeros(4), zeros(4)
    for i in range(4):
        along = wheels[X, i] * cosine - wheels[Y, i] * sine
        across = e + wheels[X, i] * sine + wheels[Y, i] * cosine
        bend = curvature * across
        stretch = 1.0 + bend * (1.0 + bend * (1.0 + bend))
        u[i] = s + along * stretch
        v[i] = across - 0.5 * curvature * along * along * stretch
        turn[i] = rotation[i] + step * spin[i]
        ground[3, i] = ground[2, i]
        ground[2, i] = ground[1, i]
        ground[1, i] = ground[0, i]
    for i in range(4):
        ground[0, i] = height(surface, elevation, u[i], v[i])
    for i in range(4):
        ground[0, i] += road_port(i, u[i], v[i], ground[0, i], turn[i], surface, elevation, parameters, states, slopes)


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _vertical(
    car, wheels, pose, now, change, slope_y, wheel_z, wheel_v, wheel_change, spin, rotation, ground, step,
    force_x, force_y, fore_push, side_push, parameters, states, slopes, load, suspension, travel_rate,
    recession, toe, scrub,
):  # fmt: skip
    """Load of every tyre, force of every suspension (N, positive pushing apart), motion of every wheel, way of its links; ``change``: of the step before."""
    half = 0.5 * step
    per_step = 1.0 / (6.0 * step)
    rest = pose[Z] - car.cg_height + car.tyre_radius
    travel, corner_speed, lean, aside = zeros(4), zeros(4), zeros(4), zeros(4)
    held, deflection, rate, tyre_damper, radial, shake = zeros(4), zeros(4), zeros(4), zeros(4), zeros(4), zeros(4)
    lean[0], lean[2] = wheel_z[0] - wheel_z[1], wheel_z[2] - wheel_z[3]
    lean[1], lean[3] = -lean[0], -lean[2]
    for i in range(4):
        side = wheels[Y, i] * pose[ROLL]
        travel[i] = wheel_z[i] - (rest - wheels[STATIC_DEFLECTION, i] - wheels[X, i] * pose[PITCH] + side)
        twist = lean[i] - 2.0 * side
        corner_speed[i] = now[V_Z] - wheels[X, i] * now[PITCH_RATE] + wheels[Y, i] * now[ROLL_RATE]
        travel_rate[i] = wheel_v[i] + half * wheel_change[i] - corner_speed[i]
        held[i] = wheels[STATIC_FORCE, i] + wheels[SPRING, i] * travel[i] + wheels[ANTI_ROLL, i] * twist
    for i in range(4):
        linear = wheels[DAMPING, i] * travel_rate[i]
        extra, damper = suspension_port(
            i, travel[i], travel_rate[i], wheels[SPRING, i], wheels[DAMPING, i], force_x[i], force_y[i], linear,
            parameters, states, slopes,
        )  # fmt: skip
        held[i] += extra + (damper - linear)
        held[i] += interconnection_port(
            i, travel[i], travel_rate[i], travel[i ^ 2], travel_rate[i ^ 2], travel[i ^ 1], travel_rate[i ^ 1], travel[i ^ 3], travel_rate[i ^ 3],
            parameters, states, slopes,
        )  # fmt: skip
        recession[i], toe[i], scrub[i] = kinematics_port(i, travel[i], parameters, states, slopes)
    moving = now[V_X] * now[YAW_RATE] + change[V_Y]
    for i in range(4):
        aside[i] = moving + wheels[X, i] * change[YAW_RATE] + wheels[ROLL_ARM, i] * change[ROLL_RATE]
        held[i] -= wheels[DAMPING, i] * corner_speed[i] + (wheels[SCRUB, i] + scrub[i]) * side_push[i]
        held[i] += recession[i] * fore_push[i] + scrub[i] * wheels[MASS, i] * aside[i]
        deflection[i] = ground[1, i] + car.tyre_radius - wheel_z[i]
        tyre_damper[i] = car.tyre_damping * min(max(deflection[i] * PER_CONTACT_DEPTH, 0.0), 1.0)
        rate[i] = (2.0 * ground[0, i] + 3.0 * ground[1, i] - 6.0 * ground[2, i] + ground[3, i]) * per_step
        radial[i] = car.tyre_stiffness * deflection[i] + tyre_damper[i] * rate[i]
    for i in range(4):
        extra, shake[i] = tyre_vertical_port(
            i, deflection[i], rate[i] - travel_rate[i] - corner_speed[i], car.tyre_stiffness, wheels[STATIC_DEFLECTION, i],
            rotation[i], spin[i], parameters, states, slopes,
        )  # fmt: skip
        radial[i] += extra
    for i in range(4):
        # Moved aside, and on a bank, its mass acts at its centre, and takes its part of what the tyre gives to the links: the body does not feel it.
        overturning = wheels[OVERTURNING, i] * (aside[i] + STANDARD_GRAVITY * slope_y) - wheels[MASS, i] * wheels[SCRUB, i] * aside[i]
        # The wheel's own damping, implicit: its speed now is that before plus half a step of its change.
        weight = wheels[MASS, i] * STANDARD_GRAVITY - shake[i] - overturning
        damping = tyre_damper[i] + wheels[DAMPING, i]
        pushed = (radial[i] - held[i] - weight - damping * wheel_v[i]) / (wheels[MASS, i] + half * damping)
        pressing = radial[i] - tyre_damper[i] * (wheel_v[i] + half * pushed)
        # In the air it is held by its own damper alone.
        lifted = pressing < 0.0 or deflection[i] <= 0.0
        free = (-held[i] - weight - wheels[DAMPING, i] * wheel_v[i]) / (wheels[MASS, i] + half * wheels[DAMPING, i])
        load[i] = 0.0 if lifted else pressing
        wheel_change[i] = free if lifted else pushed
        wheel_speed = wheel_v[i] + half * wheel_change[i]
        suspension[i] = held[i] + wheels[DAMPING, i] * wheel_speed
        travel_rate[i] = wheel_speed - corner_speed[i]


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _planar(
    car, wheels, now, surging, travel_rate, recession, toe, scrub, ground, slope_x, load, spin, spin_change, rotation, angle, demand,
    friction, step, parameters, states, slopes, torque, force_x, force_y, side_push, gripped, spin_changed,
):  # fmt: skip
    """Driving torque of every wheel and force of its tyre along the road; their spin is advanced.

    ``surging``: the acceleration of the body, carried on. ``side_push``: the side force carried on to the next step.
    ``gripped``: the longitudinal force of the tyre in the step before, but for what effects pull; ``spin_changed``: the change of spin before that.
    """
    sine, cosine = sin_cos(angle)
    half = 0.5 * step
    per_two_steps = 0.5 / step
    share_front = car.drive_share_front if demand > 0.0 else car.brake_share_front
    ahead, aside, share = zeros(4), zeros(4), zeros(4)
    c, d, rolling, per_speed, carried = zeros(4), zeros(4), zeros(4), zeros(4), zeros(4)
    slip_x, slip_y, slope, pull, surge, answer = zeros(4), zeros(4), zeros(4), zeros(4), zeros(4), zeros(4)
    for i in range(4):
        ahead[i] = cosine if i < 2 else 1.0
        aside[i] = sine if i < 2 else 0.0
        share[i] = share_front if i < 2 else 1.0 - share_front
    for i in range(4):
        along = now[V_X] - wheels[Y, i] * now[YAW_RATE] - car.pitch_arm * now[PITCH_RATE]
        across = now[V_Y] + wheels[X, i] * now[YAW_RATE] + car.cg_height * now[ROLL_RATE]
        across += (wheels[SCRUB, i] + scrub[i]) * travel_rate[i]
        along -= recession[i] * travel_rate[i]
        c[i], d[i] = ahead[i] - aside[i] * toe[i], aside[i] + ahead[i] * toe[i]
        rolling[i] = along * c[i] + across * d[i]
        sliding = across * c[i] - along * d[i]
        per_speed[i] = 1.0 / max(abs(rolling[i]), MINIMUM_SPEED)
        slope[i] = (ground[0, i] - ground[2, i]) * per_speed[i] * per_two_steps - slope_x
        # Its spin now, as the two steps before carry it on; of one alone, the force of a sliding tyre would swing from step to step.
        mean = 0.5 * (spin_change[i] + spin_changed[i])
        carried[i] = mean if spin[i] + half * mean > 0.0 else 0.0
        spin_changed[i] = spin_change[i]
        slip_x[i] = ((spin[i] + half * carried[i]) * car.tyre_radius - rolling[i]) * per_speed[i]
        slip_y[i] = -sliding * per_speed[i]
        surge[i] = surging[V_X] - now[YAW_RATE] * now[V_Y] - wheels[Y, i] * surging[YAW_RATE] - car.pitch_arm * surging[PITCH_RATE]
    for i in range(4):
        # How much of a change of slip the tyre answers to at once: none behind a lag.
        probed = tyre_planar_port(
            i, slip_x[i] + PROBE, slip_y[i], load[i], rolling[i], slope[i], gripped[i], surge[i], parameters, states, slopes,
        )[0]  # fmt: skip
        slip_x[i], slip_y[i], pull[i] = tyre_planar_port(
            i, slip_x[i], slip_y[i], load[i], rolling[i], slope[i], gripped[i], surge[i], parameters, states, slopes,
        )  # fmt: skip
        answer[i] = min(max((probed - slip_x[i]) / PROBE, 0.0), 1.0)
    for i in range(4):
        tyre_x, tyre_y, give = brush(slip_x[i], slip_y[i], load[i], friction, car.slip_per_load, car.cornering_per_load)
        torque[i] = 0.5 * share[i] * demand * car.tyre_radius
        # What the spin changes otherwise than before is taken implicitly: slip answers fast at low speed.
        grip = half * answer[i] * give * car.tyre_radius * car.slip_per_load * load[i] * per_speed[i]
        tyre_x -= grip * carried[i]
        spin_change[i] = (torque[i] - car.tyre_radius * tyre_x) / (car.spin_inertia + car.tyre_radius * grip)
        # A brake stops a wheel and holds it: it does not turn it back.
        stops = demand < 0.0 and spin[i] + step * spin_change[i] < 0.0
        spin_change[i] = -spin[i] / step if stops else spin_change[i]
        tyre_x += grip * spin_change[i]
        torque[i] = car.spin_inertia * spin_change[i] + car.tyre_radius * tyre_x if stops else torque[i]
        gripped[i] = tyre_x
        spin[i] += step * spin_change[i]
        rotation[i] += step * spin[i]
        tyre_x += pull[i]
        force_x[i] = tyre_x * c[i] - tyre_y * d[i]
        side = tyre_x * d[i] + tyre_y * c[i]
        side_push[i] = 2.0 * side - force_y[i]
        force_y[i] = side


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _accelerate(
    car, wheels, pose, now, surging, slope_x, slope_y, change, wheel_change, recession, scrub, load, force_x, force_y, torque,
    suspension, fore, fore_push, side_push, sensor, parameters, states, slopes,
):  # fmt: skip
    """Time derivatives of the speeds from the forces and moments on the body, through the mass matrix.

    ``fore_push``, ``side_push``: with what the links push, carried on to the next step, where it lifts the body over wheels that recede or move aside;
    ``fore``: the former in this step.
    Returns how the body's flexing accelerates the sensor (m/s2).
    """
    x = y = z = roll = pitch = yaw = 0.0
    for i in range(4):
        # A wheel that moves back as it rises pushes the body forward by its inertia.
        rising = wheel_change[i] - surging[V_Z] + wheels[X, i] * surging[PITCH_RATE] - wheels[Y, i] * surging[ROLL_RATE]
        push = force_x[i] + recession[i] * wheels[MASS, i] * rising
        # On a slope the tyre bears the wheel's weight, too, and the links do not. Its inertia aside is in the mass matrix.
        held_fore = push - wheels[MASS, i] * (surging[V_X] - car.pitch_arm * surging[PITCH_RATE] + STANDARD_GRAVITY * slope_x)
        fore_push[i] = 2.0 * held_fore - fore[i]
        fore[i] = held_fore
        side_push[i] -= wheels[MASS, i] * STANDARD_GRAVITY * slope_y
        # The road pushes along its normal: on a slope the load has a level part.
        push -= load[i] * slope_x
        side = force_y[i] - load[i] * slope_y
        x += push
        y += side
        z += suspension[i]
        # Where the load passes the centre of gravity: tilted with the body down to the link, with the road below.
        aside = wheels[Y, i] + wheels[ROLL_ARM, i] * pose[ROLL] + wheels[ROLL_CENTRE, i] * slope_y
        aside += scrub[i] * wheels[Y, i] * (slope_y - pose[ROLL])
        ahead = wheels[X, i] - car.pitch_arm * pose[PITCH]
        roll += car.cg_height * side + aside * suspension[i]
        pitch -= car.pitch_arm * push + torque[i] + ahead * suspension[i]
        yaw += wheels[X, i] * side - wheels[Y, i] * push
    v_x, v_y, r = now[V_X], now[V_Y], now[YAW_RATE]
    momentum_x = car.total_mass * v_x - car.unsprung_mass * car.pitch_arm * now[PITCH_RATE]
    momentum_y = car.total_mass * v_y + car.unsprung_x * r + car.unsprung_roll * now[ROLL_RATE]
    x += r * momentum_y
    y -= r * momentum_x
    yaw += v_y * momentum_x - v_x * momentum_y
    roll -= car.unsprung_roll * r * v_x
    pitch -= car.unsprung_mass * car.pitch_arm * r * v_y
    # What is shaken by the body (an engine on its mounts) answers to the acceleration of this step: a round leaves up to two thirds of the error.
    for _ in range(4):
        motion = BodyMotion(
            pose[S], now[V_X], now[V_Y], now[V_Z], pose[ROLL], pose[PITCH],
            now[ROLL_RATE], now[PITCH_RATE], now[YAW_RATE],
            change[V_Z], change[ROLL_RATE], change[PITCH_RATE],
            suspension[0] + suspension[1], suspension[2] + suspension[3],
            car.sprung_mass, wheels[X, 0], wheels[X, 2],
        )  # fmt: skip
        extra_x, extra_y, extra_z, extra_roll, extra_pitch, extra_yaw = body_port(motion, parameters, states, slopes)
        forward, side, turning = x + extra_x, y + extra_y, yaw + extra_yaw
        rolling, nodding = roll + extra_roll, pitch + extra_pitch
        change[V_X] = car.inverse_xx * forward + car.inverse_xq * nodding
        change[PITCH_RATE] = car.inverse_xq * forward + car.inverse_qq * nodding
        change[V_Y] = car.inverse_yy * side + car.inverse_yr * turning + car.inverse_yp * rolling
        change[YAW_RATE] = car.inverse_yr * side + car.inverse_rr * turning + car.inverse_rp * rolling
        change[ROLL_RATE] = car.inverse_yp * side + car.inverse_rp * turning + car.inverse_pp * rolling
        change[V_Z] = (z + extra_z) / car.sprung_mass - STANDARD_GRAVITY
    return flexing_port(motion, sensor[0], sensor[1], sensor[2], parameters, states, slopes)


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _advance(step, curvature, pose, pose_rate, speeds, change):
    """Speeds and then the pose one step on; the rates of place and heading are kept. ``curvature``: half a step on."""
    half = 0.5 * step
    for k in range(6):
        speeds[k] += step * change[k]
    sine, cosine = sin_cos(pose[HEADING] + half * pose_rate[2])
    progress = (speeds[V_X] * cosine - speeds[V_Y] * sine) / (1.0 - curvature * (pose[E] + half * pose_rate[1]))
    drift = speeds[V_X] * sine + speeds[V_Y] * cosine
    turn = speeds[YAW_RATE] - curvature * progress
    pose[S] += step * progress
    pose[E] += step * drift
    pose[HEADING] += step * turn
    pose[Z] += step * speeds[V_Z]
    pose[ROLL] += step * speeds[ROLL_RATE]
    pose[PITCH] += step * speeds[PITCH_RATE]
    pose_rate[0], pose_rate[1], pose_rate[2] = progress, drift, turn
