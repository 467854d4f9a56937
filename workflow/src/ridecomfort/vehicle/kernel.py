"""The compiled vehicle: 14 degrees of freedom, the driver, and the road under four wheels.

``reference.py`` holds the same model as plain NumPy and explains it; this file is its
fast form. Arrays are ordered as in ``motion`` (pose, speeds) and ``constants`` (wheels:
front left, front right, rear left, rear right). ``change`` holds the time derivatives of
``speeds``, ``now`` the speeds at the same instant as the pose.

Forces are evaluated once a step in a leapfrog scheme: positions at full steps, speeds
half a step later and extrapolated to the full step where forces depend on them, the
damping of the wheels taken implicitly. Second order, and symplectic where nothing dissipates.

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
    ROLL_ARM,
    ROLL_CENTRE,
    SCRUB,
    SPRING,
    STATIC_DEFLECTION,
    STATIC_FORCE,
    X,
    Y,
)
from ridecomfort.vehicle.driver import (
    SPEED_INTEGRAL_GAIN,
    SPEED_PREVIEW_TIME,
    acceleration_demand,
    steering,
)
from ridecomfort.vehicle.ground import height
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
    body = np.zeros((5, 6))
    feels = np.zeros((2, 3))
    wheel = np.zeros((17, 4))
    ground = np.zeros((4, 4))
    states = np.zeros((4, state_count))
    return _drive(
        car, wheels, surface, elevation, targets, friction * car.tyre_friction, start, end, step, every,
        sensor, parameters, record, sensed, feels[0], feels[1],
        body[0], body[1], body[2], body[3], body[4],
        wheel[0], wheel[1], wheel[2], wheel[3], wheel[4], wheel[5], wheel[6], wheel[7], wheel[8], wheel[9],
        wheel[10], wheel[11], wheel[12], wheel[13], wheel[14], wheel[15], wheel[16], ground, states[0], states[1], states[2], states[3],
    )  # fmt: skip


# Without reference counts on the arrays, which would cost as much as the physics: nothing is allocated here.
# Products and sums may be fused, which rounds once instead of twice, and regrouped, which shortens what waits for what.
@njit(error_model="numpy", _nrt=False, fastmath={"contract", "arcp", "reassoc", "nsz"})
def _drive(
    car, wheels, surface, elevation, targets, friction, start, end, step, every,
    sensor, parameters, record, sensed, felt, rates,
    pose, pose_rate, speeds, change, now,
    wheel_z, wheel_v, wheel_change, spin, spin_change, rotation, force_x, force_y, load, torque,
    suspension, travel_rate, recession, toe, scrub, fore_push, side_push, ground, states, slopes, slopes_before, slopes_earlier,
):  # fmt: skip
    half = 0.5 * step
    _settle(
        car, wheels, surface, elevation, targets, start, step, parameters, states, slopes,
        pose, pose_rate, speeds, wheel_z, wheel_v, spin, rotation, ground,
    )  # fmt: skip
    rise = height(surface, elevation, start + GRADE_LENGTH, pose[E]) - height(surface, elevation, start, pose[E])
    integral = STANDARD_GRAVITY * rise / (GRADE_LENGTH * SPEED_INTEGRAL_GAIN)

    records, steps = 0, 0
    room = min(record.shape[0] * every, sensed.shape[1])
    while pose[S] < end and speeds[V_X] > STANDSTILL and steps < room:
        for k in range(6):
            now[k] = speeds[k] + half * change[k]
        index, fraction = _locate(surface, targets, pose[S])
        curvature = _target(targets, index, fraction, CURVATURE)
        pace = max(now[V_X], MINIMUM_SPEED)

        demand, integral = _speed_control(
            car, surface, targets, index, fraction, pose[S], now[V_X], pace, integral, step
        )
        demand = drive_port(demand, now[V_X], parameters, states, slopes)
        course = pose[HEADING] + now[V_Y] / pace
        lateral = _target(targets, index, fraction, LATERAL)
        angle = steering(pose[E], course, pace, lateral, curvature, car.wheelbase)
        angle = steer_port(angle, now[V_X], force_y[0] + force_y[1], parameters, states, slopes)

        _feel(
            wheels, surface, elevation, pose, pose_rate, curvature, step, spin, rotation, parameters, states, slopes, ground
        )
        slope_x, slope_y = _plane(car, ground[1])
        _vertical(
            car, wheels, pose, now, wheel_z, wheel_v, wheel_change, spin, rotation, ground, step,
            force_x, force_y, fore_push, side_push, parameters, states, slopes, load, suspension, travel_rate,
            recession, toe, scrub,
        )  # fmt: skip
        _planar(
            car, wheels, now, travel_rate, recession, toe, scrub, ground, slope_x, slope_y, load, spin, spin_change, rotation, angle, demand,
            friction, step, parameters, states, slopes, torque, force_x, force_y, side_push,
        )  # fmt: skip
        flex_x, flex_y, flex_z = _accelerate(
            car, wheels, pose, now, slope_y, change, wheel_change, recession, scrub, force_x, force_y, torque, suspension,
            fore_push, sensor, parameters, states, slopes,
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
        _advance(step, curvature, pose, pose_rate, speeds, change)
        for k in range(len(states)):
            states[k] += step * (23.0 * slopes[k] - 16.0 * slopes_before[k] + 5.0 * slopes_earlier[k]) / 12.0
            slopes_earlier[k] = slopes_before[k]
            slopes_before[k] = slopes[k]
    return records, steps


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _locate(surface, targets, s):
    place = (s - surface.u0) * surface.per_u
    index = min(max(int(place), 0), targets.shape[0] - 2)
    return index, min(max(place - index, 0.0), 1.0)


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _target(targets, index, fraction, column):
    return targets[index, column] + fraction * (targets[index + 1, column] - targets[index, column])


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _plane(car, ground):
    """Slopes, forward and to the left, of the plane through the heights under the wheels."""
    front, rear = ground[0] + ground[1], ground[2] + ground[3]
    across = (ground[0] - ground[1]) * car.per_track_front + (ground[2] - ground[3]) * car.per_track_rear
    return 0.5 * (front - rear) * car.per_wheelbase, 0.5 * across


@njit(error_model="numpy", _nrt=False)
def _settle(
    car, wheels, surface, elevation, targets, start, step, parameters, states, slopes,
    pose, pose_rate, speeds, wheel_z, wheel_v, spin, rotation, ground,
):  # fmt: skip
    """Begin at rest on the springs, moving along the plane under the wheels."""
    index, fraction = _locate(surface, targets, start)
    curvature = _target(targets, index, fraction, CURVATURE)
    speed = _target(targets, index, fraction, SPEED)
    pose[S], pose[E] = start, _target(targets, index, fraction, LATERAL)
    pose_rate[0] = speed
    for back in range(3, 0, -1):
        pose[S] = start - back * step * speed
        _feel(
            wheels, surface, elevation, pose, pose_rate, curvature, step, spin, rotation, parameters, states, slopes, ground
        )
    pose[S] = start
    slope_x, slope_y = _plane(car, ground[0])
    middle = 0.0
    for i in range(4):
        middle += 0.25 * (ground[0, i] - wheels[i, X] * slope_x - wheels[i, Y] * slope_y)
    pose[Z], pose[ROLL], pose[PITCH] = middle + car.cg_height, slope_y, -slope_x
    speeds[V_X], speeds[YAW_RATE], speeds[V_Z] = speed, curvature * speed, slope_x * speed
    for i in range(4):
        plane = middle + wheels[i, X] * slope_x + wheels[i, Y] * slope_y
        wheel_z[i] = plane + car.tyre_radius - wheels[i, STATIC_DEFLECTION]
        wheel_v[i] = slope_x * speed
        spin[i] = speed / car.tyre_radius


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _speed_control(car, surface, targets, index, fraction, s, v_x, pace, integral, step):
    """Force in N that the driver asks for, and the integral of the speed error in m."""
    target = _target(targets, index, fraction, SPEED)
    distance = SPEED_PREVIEW_TIME * pace
    index, fraction = _locate(surface, targets, s + distance)
    ahead = _target(targets, index, fraction, SPEED)
    integral += step * (target - v_x)
    return car.total_mass * acceleration_demand(v_x, target, ahead, distance, integral), integral


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
    for i in range(4):
        along = wheels[i, X] * cosine - wheels[i, Y] * sine
        across = e + wheels[i, X] * sine + wheels[i, Y] * cosine
        bend = curvature * across
        stretch = 1.0 + bend * (1.0 + bend * (1.0 + bend))
        u = s + along * stretch
        v = across - 0.5 * curvature * along * along * stretch
        raw = height(surface, elevation, u, v)
        ground[3, i] = ground[2, i]
        ground[2, i] = ground[1, i]
        ground[1, i] = ground[0, i]
        turn = rotation[i] + step * spin[i]
        ground[0, i] = raw + road_port(i, u, v, raw, turn, surface, elevation, parameters, states, slopes)


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _vertical(
    car, wheels, pose, now, wheel_z, wheel_v, wheel_change, spin, rotation, ground, step,
    force_x, force_y, fore_push, side_push, parameters, states, slopes, load, suspension, travel_rate,
    recession, toe, scrub,
):  # fmt: skip
    """Load of every tyre, force of every suspension (N, positive pushing apart), motion of every wheel, way of its links."""
    half = 0.5 * step
    per_step = 1.0 / (6.0 * step)
    rest = pose[Z] - car.cg_height + car.tyre_radius
    for i in range(4):
        other = i + 1 if i % 2 == 0 else i - 1
        side = wheels[i, Y] * pose[ROLL]
        travel = wheel_z[i] - (rest - wheels[i, STATIC_DEFLECTION] - wheels[i, X] * pose[PITCH] + side)
        twist = wheel_z[i] - wheel_z[other] - 2.0 * side
        corner_speed = now[V_Z] - wheels[i, X] * now[PITCH_RATE] + wheels[i, Y] * now[ROLL_RATE]
        wheel_speed = wheel_v[i] + half * wheel_change[i]
        held = wheels[i, STATIC_FORCE] + wheels[i, SPRING] * travel + wheels[i, ANTI_ROLL] * twist
        held += suspension_port(
            i, travel, wheel_speed - corner_speed, wheels[i, SPRING], wheels[i, DAMPING], force_x[i], force_y[i],
            parameters, states, slopes,
        )  # fmt: skip
        recession[i], toe[i], scrub[i] = kinematics_port(i, travel, parameters, states, slopes)
        held -= wheels[i, DAMPING] * corner_speed + (wheels[i, SCRUB] + scrub[i]) * side_push[i]
        held += recession[i] * fore_push[i]

        deflection = ground[1, i] + car.tyre_radius - wheel_z[i]
        damper = car.tyre_damping * min(max(deflection * PER_CONTACT_DEPTH, 0.0), 1.0)
        rate = (2.0 * ground[0, i] + 3.0 * ground[1, i] - 6.0 * ground[2, i] + ground[3, i]) * per_step
        radial = car.tyre_stiffness * deflection + damper * rate
        radial += tyre_vertical_port(
            i, deflection, rate - wheel_speed, car.tyre_stiffness, wheels[i, STATIC_DEFLECTION], rotation[i], spin[i],
            parameters, states, slopes,
        )  # fmt: skip
        # The wheel's own damping, implicit: its speed now is that before plus half a step of its change.
        weight = wheels[i, MASS] * STANDARD_GRAVITY
        damping = damper + wheels[i, DAMPING]
        push = radial - held - weight - damping * wheel_v[i]
        wheel_change[i] = push / (wheels[i, MASS] + half * damping)
        wheel_speed = wheel_v[i] + half * wheel_change[i]
        load[i] = radial - damper * wheel_speed
        if load[i] < 0.0 or deflection <= 0.0:
            load[i] = 0.0
            push = -held - weight - wheels[i, DAMPING] * wheel_v[i]
            wheel_change[i] = push / (wheels[i, MASS] + half * wheels[i, DAMPING])
            wheel_speed = wheel_v[i] + half * wheel_change[i]
        suspension[i] = held + wheels[i, DAMPING] * wheel_speed
        travel_rate[i] = wheel_speed - corner_speed


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _planar(
    car, wheels, now, travel_rate, recession, toe, scrub, ground, slope_x, slope_y, load, spin, spin_change, rotation, angle, demand,
    friction, step, parameters, states, slopes, torque, force_x, force_y, side_push,
):  # fmt: skip
    """Driving torque and force in level axes of every wheel; their spin is advanced.

    ``side_push``: the side force carried on to the next step, where the links press with it.
    """
    sine, cosine = sin_cos(angle)
    half = 0.5 * step
    per_two_steps = 0.5 / step
    share_front = car.drive_share_front if demand > 0.0 else car.brake_share_front
    for i in range(4):
        along = now[V_X] - wheels[i, Y] * now[YAW_RATE] - car.pitch_arm * now[PITCH_RATE]
        across = now[V_Y] + wheels[i, X] * now[YAW_RATE] + car.cg_height * now[ROLL_RATE]
        across += (wheels[i, SCRUB] + scrub[i]) * travel_rate[i]
        along -= recession[i] * travel_rate[i]
        c, d = (cosine, sine) if i < 2 else (1.0, 0.0)
        c, d = c - d * toe[i], d + c * toe[i]
        rolling = along * c + across * d
        sliding = across * c - along * d
        per_speed = 1.0 / max(abs(rolling), MINIMUM_SPEED)
        slope = (ground[0, i] - ground[2, i]) * per_speed * per_two_steps - slope_x
        pushed = (torque[i] - car.spin_inertia * spin_change[i]) / car.tyre_radius
        slip_x, slip_y, pull = tyre_planar_port(
            i, (spin[i] * car.tyre_radius - rolling) * per_speed, -sliding * per_speed, load[i], rolling, slope,
            pushed, parameters, states, slopes,
        )  # fmt: skip
        tyre_x, tyre_y, give = brush(
            slip_x, slip_y, load[i], friction, car.slip_per_load, car.cornering_per_load
        )
        share = share_front if i < 2 else 1.0 - share_front
        torque[i] = 0.5 * share * demand * car.tyre_radius
        # Spin and slip force half a step on, implicit: slip answers fast at low speed.
        grip = half * give * car.tyre_radius * car.slip_per_load * load[i] * per_speed
        spin_change[i] = (torque[i] - car.tyre_radius * tyre_x) / (car.spin_inertia + car.tyre_radius * grip)
        tyre_x += grip * spin_change[i] + pull
        spin[i] += step * spin_change[i]
        rotation[i] += step * spin[i]
        # The road pushes along its normal: on a slope the load has a level part.
        force_x[i] = tyre_x * c - tyre_y * d - load[i] * slope_x
        side = tyre_x * d + tyre_y * c - load[i] * slope_y
        side_push[i] = 2.0 * side - force_y[i]
        force_y[i] = side


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _accelerate(
    car, wheels, pose, now, slope_y, change, wheel_change, recession, scrub, force_x, force_y, torque, suspension,
    fore_push, sensor, parameters, states, slopes,
):  # fmt: skip
    """Time derivatives of the speeds from the forces and moments on the body, through the mass matrix.

    ``fore_push``: with what the links push forward, for the next step, where it lifts the body over wheels that recede.
    Returns how the body's flexing accelerates the sensor (m/s2).
    """
    motion = BodyMotion(
        pose[S], now[V_X], now[V_Y], now[V_Z], pose[ROLL], pose[PITCH],
        now[ROLL_RATE], now[PITCH_RATE], now[YAW_RATE],
        change[V_Z], change[ROLL_RATE], change[PITCH_RATE],
        suspension[0] + suspension[1], suspension[2] + suspension[3],
        car.sprung_mass, wheels[0, X], wheels[2, X],
    )  # fmt: skip
    x, y, z, roll, pitch, yaw = body_port(motion, parameters, states, slopes)
    for i in range(4):
        # A wheel that moves back as it rises pushes the body forward by its inertia.
        rising = wheel_change[i] - change[V_Z] + wheels[i, X] * change[PITCH_RATE] - wheels[i, Y] * change[ROLL_RATE]
        push = force_x[i] + recession[i] * wheels[i, MASS] * rising
        fore_push[i] = push - wheels[i, MASS] * (change[V_X] - car.pitch_arm * change[PITCH_RATE])
        x += push
        y += force_y[i]
        z += suspension[i]
        # Where the load passes the centre of gravity: tilted with the body down to the link, with the road below.
        aside = wheels[i, Y] + wheels[i, ROLL_ARM] * pose[ROLL] + wheels[i, ROLL_CENTRE] * slope_y
        aside += scrub[i] * wheels[i, Y] * (slope_y - pose[ROLL])
        ahead = wheels[i, X] - car.pitch_arm * pose[PITCH]
        roll += car.cg_height * force_y[i] + aside * suspension[i]
        pitch -= car.pitch_arm * push + torque[i] + ahead * suspension[i]
        yaw += wheels[i, X] * force_y[i] - wheels[i, Y] * push
    v_x, v_y, r = now[V_X], now[V_Y], now[YAW_RATE]
    momentum_x = car.total_mass * v_x - car.unsprung_mass * car.pitch_arm * now[PITCH_RATE]
    momentum_y = car.total_mass * v_y + car.unsprung_x * r + car.unsprung_roll * now[ROLL_RATE]
    forward = x + r * momentum_y
    side = y - r * momentum_x
    yaw += v_y * momentum_x - v_x * momentum_y
    roll -= car.unsprung_roll * r * v_x
    pitch -= car.unsprung_mass * car.pitch_arm * r * v_y
    change[V_X] = car.inverse_xx * forward + car.inverse_xq * pitch
    change[PITCH_RATE] = car.inverse_xq * forward + car.inverse_qq * pitch
    change[V_Y] = car.inverse_yy * side + car.inverse_yr * yaw + car.inverse_yp * roll
    change[YAW_RATE] = car.inverse_yr * side + car.inverse_rr * yaw + car.inverse_rp * roll
    change[ROLL_RATE] = car.inverse_yp * side + car.inverse_rp * yaw + car.inverse_pp * roll
    change[V_Z] = z / car.sprung_mass - STANDARD_GRAVITY
    return flexing_port(motion, sensor[0], sensor[1], sensor[2], parameters, states, slopes)


@njit(forceinline=True, error_model="numpy", _nrt=False)
def _advance(step, curvature, pose, pose_rate, speeds, change):
    """Speeds and then the pose one step on; the rates of place and heading are kept."""
    for k in range(6):
        speeds[k] += step * change[k]
    sine, cosine = sin_cos(pose[HEADING] + 0.5 * step * pose_rate[2])
    progress = (speeds[V_X] * cosine - speeds[V_Y] * sine) / (1.0 - curvature * pose[E])
    drift = speeds[V_X] * sine + speeds[V_Y] * cosine
    turn = speeds[YAW_RATE] - curvature * progress
    pose[S] += step * progress
    pose[E] += step * drift
    pose[HEADING] += step * turn
    pose[Z] += step * speeds[V_Z]
    pose[ROLL] += step * speeds[ROLL_RATE]
    pose[PITCH] += step * speeds[PITCH_RATE]
    pose_rate[0], pose_rate[1], pose_rate[2] = progress, drift, turn
