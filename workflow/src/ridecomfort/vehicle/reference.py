"""The vehicle model in plain NumPy: slow, whole, and meant to be read. ``kernel`` must equal it.

The body is seen from level axes that turn with its heading: x forward, y left, z up. Its
speeds are q = (v_x, v_y, r, v_z, p, w): forward, to the left, yaw, up, roll and pitch rate,
of the centre of gravity of the sprung mass. Roll and pitch are small angles, so that a point
(x, y) of the body lies x * pitch below and y * roll above where it would be level.

Each wheel moves up and down and spins. Fore, aft and sideways it goes with the body, forward
at the height of its centre and sideways about the roll centre: its contact moves sideways by
scrub = (height of the roll centre) / y per metre of travel, and a side force F_y on it presses
the wheel up by scrub F_y. That makes 6 + 4 + 4 degrees of freedom.

Equations of motion in these moving axes (Boltzmann-Hamel; T is the kinetic energy)::

    d/dt dT/dv_x - r dT/dv_y                     = sum F_x
    d/dt dT/dv_y + r dT/dv_x                     = sum F_y
    d/dt dT/dr   + v_x dT/dv_y - v_y dT/dv_x     = sum (x F_y - y F_x)
    d/dt dT/dp   + sum (m_i arm) r v_x           = sum (h F_y - h_roll m_i a_i + (y + aside) S)
    d/dt dT/dw   + sum (m_i h_wheel) r v_y       = -sum (h_wheel F_x + T_i + (x + ahead) S)
    m_s (dv_z/dt + g)                            = sum S
    m_i (d2z_i/dt2 + g)                          = N_i - S_i + R / y_i m_i (a_i + g bank)
    J_i d(spin_i)/dt                             = T_i - R F_i

S: suspension force (with the push of the links), N: load of the tyre, F: its force in the
plane, T: driving torque, which the body takes up, of a brake no more than stops the wheel; h, h_wheel: heights of the centre of gravity
above the road and above the wheel centres, h_roll: of the roll centre above the road; a_i: acceleration of a wheel
sideways, bank: slope of the road to the left. A slope tilts the load: its level part is -N times
the slope of the plane through the four contacts. The radial damping of a tyre builds up over
the first CONTACT_DEPTH of its deflection. ``aside`` and ``ahead`` are how far the loads
move under the centre of gravity as body and road tilt. The unsprung masses move sideways at the
roll centre (arm below the centre of gravity). Links that swing about the roll centre move a wheel's centre aside by
(h_roll - R) / y per metre that it rises, its contact by h_roll / y: the side force less the mass's m_i (a_i + g bank) lifts it by
h_roll / y, and that mass, at the height of the centre, by R / y.

Time: leapfrog. Positions at full steps, speeds half a step later; where a force depends on a
speed, the speed is carried half a step on with the last acceleration, except that of the
wheels up and down and in spin, which are solved for (their damping is stiff; of the spin, its
change since the two steps before). The curvature is that half a step on. The push of the
links takes the side force carried on from the step before, a wheel's inertia aside the body's last acceleration.
"""

from __future__ import annotations

import numpy as np

from ..vocabulary import STANDARD_GRAVITY
from . import driver
from .ground import height
from .parameters import Vehicle

CONTACT_DEPTH = 0.005
GRADE_LENGTH = 20.0
MINIMUM_SPEED = 1.0
STANDSTILL = 0.3


class Car:
    """The vehicle's constants as arrays over the wheels: front left, front right, rear left, rear right."""

    def __init__(self, vehicle: Vehicle):
        def axles(name):
            return np.repeat([vehicle[f"{name}_front"], vehicle[f"{name}_rear"]], 2)

        front = vehicle["cg_to_front_axle"]
        self.x = np.repeat([front, front - vehicle["wheelbase"]], 2)
        self.track = axles("track")
        self.y = np.array([1, -1, 1, -1]) * self.track / 2
        self.wheel_mass = axles("unsprung_mass")
        self.body_mass = vehicle["sprung_mass"]
        self.spring, self.damper = axles("spring_stiffness"), axles("damping")
        self.bar = axles("anti_roll_stiffness") / self.track**2
        self.roll_centre = axles("roll_centre_height")
        self.arm = vehicle["cg_height"] - self.roll_centre
        self.scrub = self.roll_centre / self.y
        self.height = vehicle["cg_height"]
        self.radius = vehicle["tyre_radius"]
        self.wheel_height = self.height - self.radius
        self.tyre_stiffness, self.tyre_damping = vehicle["tyre_radial_stiffness"], vehicle["tyre_radial_damping"]
        self.friction = vehicle["tyre_friction"]
        self.cornering = vehicle["cornering_stiffness"] / vehicle["tyre_reference_load"]
        self.slip = vehicle["longitudinal_slip_stiffness"] / vehicle["tyre_reference_load"]
        self.spin_inertia = vehicle["wheel_spin_inertia"]
        self.wheelbase = vehicle["wheelbase"]
        self.drive = self._shares(vehicle["drive_share_front"])
        self.brake = self._shares(vehicle["brake_share_front"])
        share = np.abs(self.x[[2, 3, 0, 1]]) / self.wheelbase / 2
        self.held = self.body_mass * STANDARD_GRAVITY * share
        self.pressed = (self.held + self.wheel_mass * STANDARD_GRAVITY) / self.tyre_stiffness
        self.mass_matrix = self._mass_matrix(
            vehicle["roll_inertia"], vehicle["pitch_inertia"], vehicle["yaw_inertia"]
        )

    @staticmethod
    def _shares(front):
        return np.array([front, front, 1 - front, 1 - front]) / 2

    def _mass_matrix(self, roll_inertia, pitch_inertia, yaw_inertia):
        """d2T/dq2. Each wheel moves with (v_x - y r - h w, v_y + x r + arm p)."""
        matrix = np.diag(
            [self.body_mass, self.body_mass, yaw_inertia, self.body_mass, roll_inertia, pitch_inertia]
        )
        for x, y, arm, mass in zip(self.x, self.y, self.arm, self.wheel_mass, strict=True):
            forward = np.array([1, 0, -y, 0, 0, -self.wheel_height])
            sideways = np.array([0, 1, x, 0, arm, 0])
            matrix += mass * (np.outer(forward, forward) + np.outer(sideways, sideways))
        return matrix

    def plane(self, ground):
        """Slopes forward and to the left of the plane through heights under the wheels."""
        forward = (ground[0] + ground[1] - ground[2] - ground[3]) / (2 * self.wheelbase)
        left = ((ground[0] - ground[1]) / self.track[0] + (ground[2] - ground[3]) / self.track[2]) / 2
        return forward, left


def drive(
    vehicle, surface, elevation, targets, friction, start, end, step, every, sensor=(0.0, 0.0, 0.0), watch=None
):
    """Records (records, COLUMNS) and what the sensor senses (6, steps), accelerations and rates, as ``kernel.drive`` gives them.

    ``watch`` is called at every step with a dictionary of what the car does at that instant.
    """
    car = Car(vehicle)
    mu = friction * car.friction
    u = surface.u0 + np.arange(len(targets)) / surface.per_u

    def target(s, column):
        return np.interp(s, u, targets[:, column])

    def under_wheels(s, e, heading, curvature):
        along = car.x * np.cos(heading) - car.y * np.sin(heading)
        across = e + car.x * np.sin(heading) + car.y * np.cos(heading)
        bend = curvature * across
        stretch = 1 + bend + bend**2 + bend**3
        places = zip(s + along * stretch, across - curvature * along**2 * stretch / 2, strict=True)
        return np.array([height(surface, elevation, *place) for place in places])

    speed, curvature = target(start, 0), target(start, 2)
    s, e, heading = start, target(start, 1), 0.0
    ground = [under_wheels(s - back * step * speed, e, heading, curvature) for back in range(3)]
    slope_x, slope_y = car.plane(ground[0])
    middle = np.mean(ground[0] - car.x * slope_x - car.y * slope_y)
    z, roll, pitch = middle + car.height, slope_y, -slope_x
    q = np.array([speed, 0.0, curvature * speed, slope_x * speed, 0.0, 0.0])
    wheel_z = middle + car.x * slope_x + car.y * slope_y + car.radius - car.pressed
    wheel_v = np.full(4, slope_x * speed)
    spin = np.full(4, speed / car.radius)
    rise = height(surface, elevation, s + GRADE_LENGTH, e) - height(surface, elevation, s, e)
    integral = STANDARD_GRAVITY * rise / GRADE_LENGTH / driver.SPEED_INTEGRAL_GAIN
    acceleration, wheel_acceleration, side = np.zeros(6), np.zeros(4), np.zeros(4)
    side_push, spin_change, spin_change_before = np.zeros(4), np.zeros(4), np.zeros(4)
    rates = np.array([speed, 0.0, 0.0])
    records, sensed = [], []

    while s < end and q[0] > STANDSTILL:
        v_x, v_y, r, v_z, p, w = now = q + step / 2 * acceleration
        pace = max(v_x, MINIMUM_SPEED)
        curvature = target(s, 2)

        wish = target(s, 0)
        integral += step * (wish - v_x)
        distance = driver.SPEED_PREVIEW_TIME * pace
        demand = (car.body_mass + car.wheel_mass.sum()) * driver.acceleration_demand.py_func(
            v_x, wish, target(s + distance, 0), distance, integral
        )
        angle = driver.steering.py_func(e, heading + v_y / pace, pace, target(s, 1), curvature, car.wheelbase)

        ahead = under_wheels(
            s + step * rates[0], e + step * rates[1], heading + step * rates[2], curvature
        )
        ground_rate = (2 * ahead + 3 * ground[0] - 6 * ground[1] + ground[2]) / (6 * step)
        slope_x, slope_y = car.plane(ground[0])

        corner_z = z - car.height + car.radius - car.pressed - car.x * pitch + car.y * roll
        corner_v = v_z - car.x * w + car.y * p
        travel = wheel_z - corner_z
        twist = (wheel_z - wheel_z[[1, 0, 3, 2]]) - 2 * car.y * roll
        spring = car.held + car.spring * travel + car.bar * twist - car.damper * corner_v
        wheel_side = acceleration[1] + r * v_x + car.x * acceleration[2] + car.arm * acceleration[4]
        spring = spring - car.scrub * (side_push - car.wheel_mass * wheel_side)
        deflection = ground[0] + car.radius - wheel_z
        tyre_damper = car.tyre_damping * np.clip(deflection / CONTACT_DEPTH, 0.0, 1.0)
        tyre = car.tyre_stiffness * deflection + tyre_damper * ground_rate
        weight = car.wheel_mass * STANDARD_GRAVITY
        bearing = weight - car.wheel_mass * (wheel_side + STANDARD_GRAVITY * slope_y) * car.radius / car.y
        damping = tyre_damper + car.damper
        wheel_acceleration = (tyre - spring - bearing - damping * wheel_v) / (car.wheel_mass + step / 2 * damping)
        load = tyre - tyre_damper * (wheel_v + step / 2 * wheel_acceleration)
        lifted = (load < 0) | (deflection <= 0)
        free = (-spring - bearing - car.damper * wheel_v) / (car.wheel_mass + step / 2 * car.damper)
        load = np.where(lifted, 0.0, load)
        wheel_acceleration = np.where(lifted, free, wheel_acceleration)
        wheel_now = wheel_v + step / 2 * wheel_acceleration
        suspension = spring + car.damper * wheel_now

        steer = np.array([angle, angle, 0.0, 0.0])
        along = v_x - car.y * r - car.wheel_height * w
        across = v_y + car.x * r + car.height * p + car.scrub * (wheel_now - corner_v)
        rolling = along * np.cos(steer) + across * np.sin(steer)
        sliding = across * np.cos(steer) - along * np.sin(steer)
        base = np.maximum(np.abs(rolling), MINIMUM_SPEED)
        carried = (spin_change + spin_change_before) / 2
        carried = np.where(spin + step / 2 * carried > 0, carried, 0.0)
        grip_x = car.slip * ((spin + step / 2 * carried) * car.radius - rolling) / base / mu
        grip_y = -car.cornering * sliding / base / mu
        total = np.hypot(grip_x, grip_y)
        share = np.where(total < 3, 1 - total / 3 + total**2 / 27, 1 / np.maximum(total, 3))
        tyre_x, tyre_y = mu * load * share * grip_x, mu * load * share * grip_y
        torque = (car.drive if demand > 0 else car.brake) * demand * car.radius
        give = np.where(total < 3, (1 - total / 3) ** 2, 0.0)
        stiffness = step / 2 * give * car.radius * car.slip * load / base
        tyre_x = tyre_x - stiffness * carried
        spin_change_before = spin_change
        spin_change = (torque - car.radius * tyre_x) / (car.spin_inertia + car.radius * stiffness)
        stops = (demand < 0) & (spin + step * spin_change < 0)
        spin_change = np.where(stops, -spin / step, spin_change)
        tyre_x = tyre_x + stiffness * spin_change
        torque = np.where(stops, car.spin_inertia * spin_change + car.radius * tyre_x, torque)
        force_x = tyre_x * np.cos(steer) - tyre_y * np.sin(steer) - load * slope_x
        along_road = tyre_x * np.sin(steer) + tyre_y * np.cos(steer)
        side_push = 2 * along_road - side - weight * slope_y
        side = along_road
        force_y = side - load * slope_y

        aside = car.arm * roll + car.roll_centre * slope_y
        ahead_of = -car.wheel_height * pitch
        turning_wheels = r * car.wheel_mass
        momentum = car.mass_matrix @ now
        force = np.array(
            [
                np.sum(force_x) + r * momentum[1],
                np.sum(force_y) - r * momentum[0],
                np.sum(car.x * force_y - car.y * force_x) - v_x * momentum[1] + v_y * momentum[0],
                np.sum(suspension) - car.body_mass * STANDARD_GRAVITY,
                np.sum(
                    car.height * force_y
                    - car.roll_centre * car.wheel_mass * wheel_side
                    + (car.y + aside) * suspension
                    - car.arm * turning_wheels * v_x
                ),
                -np.sum(
                    car.wheel_height * (force_x + turning_wheels * v_y)
                    + torque
                    + (car.x + ahead_of) * suspension
                ),
            ]
        )
        acceleration = np.linalg.solve(car.mass_matrix, force)

        if watch is not None:
            watch(
                dict(z=z, roll=roll, pitch=pitch, speeds=now, wheel_z=wheel_z, wheel_v=wheel_now, spin=spin,
                     travel=travel, twist=twist, deflection=deflection, load=load, suspension=suspension,
                     force_x=force_x, force_y=force_y, angle=angle, heading=heading, acceleration=acceleration)
            )  # fmt: skip
        turning = _in_body_axes(np.array([p, w, r]), roll, pitch)
        sensed.append([*_felt(sensor, now, acceleration, roll, pitch), *turning])
        if (len(sensed) - 1) % every == 0:
            along_body = v_x * (1 - pitch**2 / 2) - pitch * v_z
            records.append([s, e, along_body, *np.full(6, np.nan), roll, pitch])

        spin = spin + step * spin_change
        wheel_v = wheel_v + step * wheel_acceleration
        wheel_z = wheel_z + step * wheel_v
        q = q + step * acceleration
        middle_heading = heading + step / 2 * rates[2]
        curvature = target(s + step / 2 * rates[0], 2)
        bend = curvature * (e + step / 2 * rates[1])
        progress = (q[0] * np.cos(middle_heading) - q[1] * np.sin(middle_heading)) / (1 - bend)
        drift = q[0] * np.sin(middle_heading) + q[1] * np.cos(middle_heading)
        rates = np.array([progress, drift, q[2] - curvature * progress])
        s, e, heading = s + step * rates[0], e + step * rates[1], heading + step * rates[2]
        z, roll, pitch = z + step * q[3], roll + step * q[4], pitch + step * q[5]
        ground = [ahead, *ground[:2]]
    return np.array(records), np.array(sensed).T


def _in_body_axes(vector, roll, pitch):
    """A vector of the level axes in axes tilted by small roll and pitch."""
    x, y, z = vector
    return np.array([x - pitch * z, y + roll * z, z + pitch * x - roll * y])


def _cross(a, b):
    """Cross product; ``np.cross`` is made for long lists of vectors and takes a quarter of a drive."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _felt(sensor, now, acceleration, roll, pitch):
    """Acceleration of a sensor fixed to the body: of the centre of gravity, of turning faster, of turning."""
    v_x, v_y, r, _, p, w = now
    x, y, z = sensor
    place = np.array([x + pitch * z, y - roll * z, z - pitch * x + roll * y])
    turning = np.array([p, w, r])
    turning_faster = acceleration[[4, 5, 2]] + _cross(np.array([0.0, 0.0, r]), turning)
    centre = np.array([acceleration[0] - r * v_y, acceleration[1] + r * v_x, acceleration[3]])
    felt = centre + _cross(turning_faster, place) + _cross(turning, _cross(turning, place))
    return _in_body_axes(felt, roll, pitch)
