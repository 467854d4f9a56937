"""The parameters of a vehicle: names, units, plausible ranges, and a vehicle read from its file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Real
from pathlib import Path
from types import MappingProxyType

from ..errors import InputError, hint
from ..schema import read_yaml, validate


@dataclass(frozen=True)
class Parameter:
    """A parameter of the vehicle: unit, range outside of which a value is refused, meaning."""

    unit: str
    lower: float
    upper: float
    meaning: str


PARAMETERS: Mapping[str, Parameter] = MappingProxyType(
    {
        "sprung_mass": Parameter("kg", 300, 8000, "mass carried by the springs, driver and instruments included"),
        "unsprung_mass_front": Parameter("kg", 5, 500, "mass of one front wheel with its share of the suspension"),
        "unsprung_mass_rear": Parameter("kg", 5, 500, "mass of one rear wheel with its share of the suspension"),
        "roll_inertia": Parameter("kg m2", 50, 10000, "inertia of the sprung mass about its x axis"),
        "pitch_inertia": Parameter("kg m2", 200, 40000, "inertia of the sprung mass about its y axis"),
        "yaw_inertia": Parameter("kg m2", 200, 40000, "inertia of the sprung mass about its z axis"),
        "wheelbase": Parameter("m", 1.5, 6.0, "distance between the axles"),
        "cg_to_front_axle": Parameter("m", 0.3, 5.0, "distance of the centre of gravity of the sprung mass behind the front axle"),
        "cg_height": Parameter("m", 0.2, 2.0, "height of the centre of gravity of the sprung mass above the road at rest"),
        "track_front": Parameter("m", 0.8, 2.6, "distance between the front wheels"),
        "track_rear": Parameter("m", 0.8, 2.6, "distance between the rear wheels"),
        "spring_stiffness_front": Parameter("N/m", 5000, 300000, "stiffness of one front spring, at the wheel"),
        "spring_stiffness_rear": Parameter("N/m", 5000, 300000, "stiffness of one rear spring, at the wheel"),
        "damping_front": Parameter("N s/m", 0, 30000, "damping of one front damper, at the wheel"),
        "damping_rear": Parameter("N s/m", 0, 30000, "damping of one rear damper, at the wheel"),
        "anti_roll_stiffness_front": Parameter("N m/rad", 0, 300000, "roll stiffness of the front anti-roll bar"),
        "anti_roll_stiffness_rear": Parameter("N m/rad", 0, 300000, "roll stiffness of the rear anti-roll bar"),
        "roll_centre_height_front": Parameter("m", -0.3, 1.0, "height of the front roll centre above the road"),
        "roll_centre_height_rear": Parameter("m", -0.3, 1.0, "height of the rear roll centre above the road"),
        "tyre_radius": Parameter("m", 0.2, 0.8, "radius of the unloaded tyre"),
        "tyre_radial_stiffness": Parameter("N/m", 80000, 2000000, "radial stiffness of one tyre"),
        "tyre_radial_damping": Parameter("N s/m", 0, 20000, "radial damping of one tyre"),
        "tyre_reference_load": Parameter("N", 500, 50000, "load at which the slip stiffnesses hold; they grow in proportion to load"),
        "cornering_stiffness": Parameter("N/rad", 10000, 800000, "lateral slip stiffness of one tyre at the reference load"),
        "longitudinal_slip_stiffness": Parameter("N", 10000, 1500000, "longitudinal slip stiffness of one tyre at the reference load"),
        "tyre_friction": Parameter("1", 0.1, 2.0, "friction of the tyre on a dry road; multiplied by that of the road"),
        "wheel_spin_inertia": Parameter("kg m2", 0.1, 30, "inertia of one wheel about its axle"),
        "drive_share_front": Parameter("1", 0, 1, "share of the driving torque that goes to the front axle"),
        "brake_share_front": Parameter("1", 0, 1, "share of the braking torque that goes to the front axle"),
    }
)


@dataclass(frozen=True)
class Vehicle:
    """A vehicle: the value of every parameter (SI), where it comes from, and a name."""

    name: str
    values: Mapping[str, float]
    sources: Mapping[str, str] = field(default_factory=dict)

    def __getitem__(self, parameter: str) -> float:
        return self.values[parameter]

    def replace(self, **values: float) -> Vehicle:
        """The same vehicle with some values changed; ranges and the place of the centre of gravity are checked again."""
        changed = {**self.values, **{name: _check(name, value, None) for name, value in values.items()}}
        _check_place(changed, None)
        return Vehicle(self.name, MappingProxyType(changed), self.sources)

    def about(self, parameter: str) -> tuple[float, float]:
        """Half and twice the value of a parameter, as far as it is plausible, the lower one first."""
        span = PARAMETERS[parameter]
        lower, upper = sorted(min(max(factor * self[parameter], span.lower), span.upper) for factor in (0.5, 2.0))
        return lower, upper


def read(path) -> Vehicle:
    """A vehicle from its YAML file: for each parameter ``{value, unit, source}``.

    Raises InputError for an unknown, missing or implausible parameter and for a wrong unit.
    """
    path = Path(path)
    parameters = validate(read_yaml(path), "vehicle", path)["parameters"]
    values, sources = {}, {}
    for name, entry in parameters.items():
        if name not in PARAMETERS:
            raise InputError(f"unknown parameter {name!r}; {hint(name, PARAMETERS)}", file=path, place="parameters")
        if str(entry["unit"]) != PARAMETERS[name].unit:
            raise InputError(
                f"unit {entry['unit']!r}, expected {PARAMETERS[name].unit!r}", file=path, place=name
            )
        values[name] = _check(name, entry["value"], path)
        sources[name] = str(entry["source"])
    for name in PARAMETERS:
        if name not in values:
            raise InputError(f"parameter {name!r} is missing", file=path)
    _check_place(values, path)
    return Vehicle(path.stem, MappingProxyType(values), MappingProxyType(sources))


def _check(name: str, value, path) -> float:
    parameter = PARAMETERS.get(name)
    if parameter is None:
        raise InputError(f"unknown vehicle parameter {name!r}", file=path)
    if isinstance(value, bool) or not isinstance(value, Real) or not parameter.lower <= value <= parameter.upper:
        raise InputError(
            f"{value!r} {parameter.unit}, expected {parameter.lower:g} to {parameter.upper:g} {parameter.unit}",
            file=path,
            place=name,
        )
    return float(value)


def _check_place(values: Mapping[str, float], path) -> None:
    """Raise InputError where the centre of gravity lies behind the rear axle, as far as both are known."""
    place, wheelbase = (values.get(name) for name in ("cg_to_front_axle", "wheelbase"))
    if None not in (place, wheelbase) and place >= wheelbase:
        raise InputError(f"{place:g} m lies behind the rear axle (wheelbase {wheelbase:g} m)", file=path, place="cg_to_front_axle")
