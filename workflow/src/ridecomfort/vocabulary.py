"""Names, units and long names of every variable: written once, used by all.

SI units inside. Axes follow ISO 8855 (x forward, y left, z up); ``u`` runs along
the reference line of the road and ``v`` to its left, as in OpenCRG. Roll is
positive with the left side up, pitch with the nose down, yaw to the left.

Accelerations are those of a point of the body resolved along its own axes,
without gravity: ``a_z`` is zero at rest. What an accelerometer reads instead
(specific force) is made from them by ``drive.record.specific_force``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Variable:
    """A quantity of the study: its name in every file, its unit and its meaning. Without a unit (""), where it is stacked over quantities
    of several, the meaning says which."""

    name: str
    unit: str
    long_name: str
    standard_name: str | None = None


def _table(*rows) -> dict[str, Variable]:
    return {row[0]: Variable(*row) for row in rows}


VARIABLES = _table(
    ("time", "s", "time since the start of the drive"),
    ("run", "1", "index of the simulated drive"),
    ("drive", "1", "name of the measured drive"),
    ("u", "m", "distance along the reference line of the road"),
    ("v", "m", "distance to the left of the reference line"),
    ("elevation", "m", "height of the road surface", "surface_altitude"),
    ("x", "m", "easting of the reference line"),
    ("y", "m", "northing of the reference line"),
    ("heading", "rad", "heading of the reference line, counterclockwise from x"),
    ("curvature", "1/m", "curvature of the reference line, positive to the left"),
    ("slope", "1", "slope of the reference line, positive uphill"),
    ("bank", "1", "cross slope that the file stores heights against (of a scan: roll of the scanner), left side up"),
    ("wavenumber", "1/m", "wavenumber of the road profile, in cycles"),
    ("band", "1/m", "centre wavenumber of the band, in cycles"),
    ("displacement_psd", "m3", "power spectral density of the height of the road"),
    ("smoothed_psd", "m3", "power spectral density of the height of the road, mean over the band"),
    ("unevenness", "m3", "displacement spectral density fitted at 0.1 cycles/m"),
    ("waviness", "1", "exponent with which the fitted spectral density falls with wavenumber"),
    ("coherence", "1", "coherence of the heights of two tracks"),
    ("support", "1", "laser points that agree on the height of the cell"),
    ("kind", "1", "what the place is: dip, bump, joint, or how it was treated"),
    ("u_middle", "m", "middle of the place along the reference line"),
    ("v_middle", "m", "middle of the place to the left of the reference line"),
    ("length", "m", "extent of the place along the reference line"),
    ("width", "m", "extent of the place across the road"),
    ("height", "m", "height of its deepest or highest cell above the road around"),
    ("cells", "1", "cells of the grid that the place covers"),
    ("stage", "1", "the road as measured, repaired, smoothed"),
    ("trial_cutoff", "m", "wavelength tried as cut-off of the smoothing"),
    ("held_out_error", "m", "rms error of the smoothed heights against held-out ones"),
    ("cutoff", "m", "wavelength that smoothing halves, of the smallest error"),
    ("penalty", "m4", "weight of the squared second derivative in the smoothing spline"),
    ("a_z_rms", "m/s2", "rms of the vertical acceleration over the drive"),
    ("a_z_peak", "m/s2", "largest vertical acceleration of the drive, up or down"),
    ("acceleration_psd", "m2/s3", "power spectral density of the vertical acceleration"),
    ("frequency", "Hz", "frequency"),
    ("v_x", "m/s", "speed of the body along its x axis"),
    ("a_x", "m/s2", "acceleration of the body along its x axis"),
    ("a_y", "m/s2", "acceleration of the body along its y axis"),
    ("a_z", "m/s2", "acceleration of the body along its z axis"),
    ("roll_rate", "rad/s", "roll rate of the body"),
    ("pitch_rate", "rad/s", "pitch rate of the body"),
    ("yaw_rate", "rad/s", "yaw rate of the body"),
    ("roll", "rad", "roll angle of the body against the horizontal"),
    ("pitch", "rad", "pitch angle of the body against the horizontal"),
    ("s", "m", "distance of the body along the reference line"),
    ("e", "m", "lateral offset of the body from the reference line, positive to the left"),
    ("speed", "m/s", "speed that the driver aims for"),
    ("speed_deviation", "m/s", "deviation of a run from the speed profile of the site"),
    ("lateral_position", "m", "lateral position in the lane that a run holds"),
    ("road_friction", "1", "friction of the road surface, relative to the tyre's dry friction"),
    ("role", "1", "fit: the model is fitted to the drive; check: it is not"),
    ("gravity", "1", "1 where the instrument recorded specific force, 0 where acceleration"),
    ("sensor_x", "m", "place of the sensor before the centre of gravity of the sprung mass"),
    ("sensor_y", "m", "place of the sensor to the left of the centre of gravity of the sprung mass"),
    ("sensor_z", "m", "place of the sensor above the centre of gravity of the sprung mass"),
    ("place_measured", "1", "1 where s was measured, 0 where it is an integral of the speed"),
    ("cut_off", "Hz", "cut-off of the low-pass that all inertial signals of the record went through"),
    ("start_time", "s", "first instant of the drive on the clock of its record"),
    ("way_before", "m", "way driven before the first instant since the record would begin without its s"),
    ("clock_offset", "s", "how much later the inertial signals stand in the record than place and speed"),
    ("clock_offset_error", "s", "standard error of the clock offset"),
    ("clock_correction", "s", "clock offset left after alignment"),
    ("path_correction", "m", "distance of the path to the left of the aligned one, left after alignment"),
    ("speed_scale", "1", "true over recorded speed"),
    ("distance_offset", "m", "distance along the reference line where the record has zero"),
    ("lateral_correction", "m", "distance of the path to the left of the recorded one"),
    ("distance_wander", "m", "rms of the slow errors of s along the drive"),
    ("lateral_wander", "m", "rms of the distance of the path from a constant distance to the recorded one"),
    ("acceleration_gain", "1", "recorded over true specific force"),
    ("yaw_rate_gain", "1", "recorded yaw rate over that of the path below 0.2 Hz"),
    ("mounting_roll", "rad", "rotation of the instrument against the body about its x axis"),
    ("mounting_pitch", "rad", "rotation of the instrument against the body about its y axis"),
    ("mounting_yaw", "rad", "rotation of the instrument against the body about its z axis"),
    ("roll_rate_bias", "rad/s", "recorded roll rate at rest"),
    ("pitch_rate_bias", "rad/s", "recorded pitch rate at rest"),
    ("yaw_rate_bias", "rad/s", "recorded yaw rate at rest"),
    ("rmse", "", "root mean square of simulated minus measured, in the unit of the signal"),
    ("nrmse", "1", "rmse over the range of the measured signal"),
    ("floor_rmse", "", "rmse that repeats of the drive differ by, in the unit of the signal"),
    ("explainable_rmse", "", "root of the mean square error above the floor, in the unit of the signal"),
    ("floor_time_share", "1", "least share of the time that holds half of what repeats of the drive differ by"),
    ("explained_share", "1", "share of the first state's mean square error above the floor that is gone"),
    ("suspension_velocity", "m/s", "velocity of compression of the suspension, rms over the wheels"),
    ("tyre_velocity", "m/s", "velocity of compression of the tyre, rms over the wheels"),
    ("road_heave", "m", "mean height of the road under the front wheels"),
    ("road_tilt", "m", "height of the road under the front left wheel above that under the right one"),
    ("square_by_stretch", "", "mean square of what is judged of the error over stretches of road, in the unit of the signal squared"),
    ("stretch_of_road", "m", "start of the stretch over which the error ladder takes errors together"),
    ("error_power", "", "mean square error, in the unit of the signal squared"),
    ("floor_power", "", "mean square of the floor, in the unit of the signal squared"),
    ("band_floor", "", "mean square of the floor over all of the road, in the unit of the signal squared"),
    ("measured_power", "", "mean square of the measured signal, in the unit of the signal squared"),
    ("power_share", "1", "mean square error above the floor over that of the measured signal in all bands"),
    ("explainable_share", "1", "mean square error above the floor over its sum in the bands that lie above it"),
    ("error_map", "", "power spectral density of the error, in the unit of the signal squared per Hz"),
    ("floor_density", "", "power spectral density of the floor, in the unit of the signal squared per Hz"),
    ("measured_density", "", "power spectral density of the measured signal, in its unit squared per Hz"),
    ("simulated_density", "", "power spectral density of the simulated signal, in its unit squared per Hz"),
    ("error_density", "", "power spectral density of the error, in the unit of the signal squared per Hz"),
    ("condition_edge", "", "edges of the classes of a condition, in its SI unit"),
    ("condition_level", "", "mean of a condition in each class, in its SI unit"),
    ("condition_share", "1", "share of the time that each class of a condition holds"),
    ("condition_error", "", "mean square error in each class of a condition, in the unit of the signal squared"),
    ("condition_measured", "", "mean square of the measured signal in each class of a condition, in its unit squared"),
    ("stretch_start", "m", "start of the stretch that a finding is about"),
    ("stretch_end", "m", "end of the stretch that a finding is about"),
    ("s_map", "m", "distance along the reference line"),
    ("frequency_map", "Hz", "frequency"),
    ("model_gain", "1", "gain from the simulated to the measured signal"),
    ("model_phase", "rad", "phase from the simulated to the measured signal"),
    ("model_coherence", "1", "coherence of the simulated and the measured signal"),
    ("road_gain", "", "gain from the speed of the road under the front wheels to the signal, in its unit per m/s"),
    ("road_coherence", "1", "coherence of the speed of the road under the front wheels and the signal"),
    ("grade", "1", "class of the section by the method, 0: not critical, -1: not driven"),
    ("repeat_group", "1", "number that drives share which repeat one another"),
    ("left", "1", "mean square error above the floor over that of the rung that is the attribute reference"),
    ("left_overall", "1", "mean square error above the floor over that of the rung that is the attribute reference, all signals"),
    ("falling", "1", "share of the stretches of the drives in which left_overall falls from the rung before"),
    ("fall_p_value", "1", "probability that chance alone makes left_overall fall so from the rung before"),
    ("compared", "1", "sections that are compared"),
    ("critical_simulated", "1", "critical sections of the replays"),
    ("critical_measured", "1", "critical sections of the measured drives"),
    ("agreeing", "1", "sections that the replay grades as the measured drive"),
    ("changed", "1", "sections that the replay grades otherwise than on the rung before"),
    ("changed_in_all", "1", "sections that the replay grades otherwise than the calibrated base model"),
    ("repeats_agreeing", "1", "share of the sections that repeats of a drive grade alike"),
    ("a_wx", "m/s2", "running rms of the frequency-weighted acceleration along x"),
    ("a_wy", "m/s2", "running rms of the frequency-weighted acceleration along y"),
    ("a_wz", "m/s2", "running rms of the frequency-weighted acceleration along z"),
    ("a_v", "m/s2", "vibration total value of the frequency-weighted accelerations"),
    ("weighted_rms", "m/s2", "rms of the frequency-weighted acceleration over the evaluated stretch"),
    ("mtvv", "m/s2", "largest running rms of the frequency-weighted acceleration over the evaluated stretch"),
    ("crest_factor", "1", "largest frequency-weighted acceleration of the evaluated stretch over its rms"),
    ("vdv", "m/s1.75", "vibration dose value of the frequency-weighted acceleration over the evaluated stretch"),
    ("msdv_z", "m/s1.5", "motion sickness dose value of the vertical acceleration over the evaluated stretch"),
    ("duration", "s", "time that the run takes over the evaluated stretch"),
    ("iri", "m/km", "International Roughness Index"),
    ("window", "1", "index of the section along the road"),
    ("window_start", "m", "start of the section along the reference line"),
    ("critical", "1", "whether the section is critical"),
    ("exceedance_probability", "1", "share of the runs in which the section is critical"),
    ("exceedance_lower", "1", "lower bound of the probability, 95 % interval over the runs"),
    ("exceedance_upper", "1", "upper bound of the probability, 95 % interval over the runs"),
    ("critical_count", "1", "number of critical sections"),
    ("critical_share", "percent", "share of the sections that are critical"),
    ("run_share", "percent", "share of the sections that are critical in each run"),
    ("iri_full", "m/km", "International Roughness Index, continuous over the length of a section"),
    ("iri_track", "m/km", "International Roughness Index of each wheel track"),
    ("hri", "m/km", "International Roughness Index of the mean profile of the wheel tracks"),
    ("track", "m", "distance of the wheel track to the left of the reference line"),
    ("critical_full", "1", "whether the section is of the class by the continuous IRI"),
    ("critical_count_full", "1", "number of sections of the class by the continuous IRI"),
    ("window_mean", "m/s2", "mean of the total value over the section"),
    ("measured", "", "measured signal, in the unit of the signal"),
    ("simulated", "", "simulated signal, in the unit of the signal"),
    ("residual", "", "simulated minus measured signal, in the unit of the signal"),
    ("signal", "1", "name of the signal"),
    ("signal_unit", "1", "unit of the signal"),
    ("state", "1", "model that was driven: reference (with the vehicle's file), calibrated, or with_effects (not calibrated)"),
    ("condition", "1", "condition of the drive that errors are told by"),
    ("source", "1", "what drove: the measured vehicle or a model"),
    ("band_lower", "Hz", "lower edge of the band"),
    ("band_upper", "Hz", "upper edge of the band"),
    ("goes_with", "1", "other signal of the model that the measured one goes with, if any"),
    ("against", "1", "correlation with the model where it speaks for a wrong sign, else 0"),
    ("ratio", "1", "rms of the measured signal over that of the model"),
    ("method", "1", "comfort method"),
    ("axis", "1", "acceleration that the value is of"),
    ("jerk", "1", "jerk that the value is of"),
    ("jerk_source", "1", "where the limits of the jerk are from"),
    ("treated", "1", "what was done to the height of the cell"),
    ("treatment", "1", "what was done to the record before it was aligned"),
    ("faults", "1", "what the samples of the record show of an instrument or a logger that fails; empty for nothing"),
    ("class", "1", "class of the unevenness (ISO 8608)"),
    ("direction", "1", "direction that was smoothed"),
    ("parameter", "1", "parameter of the vehicle, or `effect.parameter` of an effect"),
    ("other", "1", "the other parameter of a pair"),
    ("unit", "1", "unit of the parameter"),
    ("value", "", "value of the parameter, in its SI unit"),
    ("initial", "", "value of the parameter before calibration, in its SI unit"),
    ("lower", "", "lower bound of the parameter, in its SI unit"),
    ("upper", "", "upper bound of the parameter, in its SI unit"),
    ("interval_lower", "", "lower end of the 90 % interval of the parameter, in its SI unit"),
    ("interval_upper", "", "upper end of the 90 % interval of the parameter, in its SI unit"),
    ("value_sequence", "", "value of the parameter at the end of the sequence, one after the other, in its SI unit"),
    ("verdict", "1", "whether the drives tell the parameter"),
    ("signal_share", "1", "share of the signal in what is known of the parameter"),
    ("singular_value", "1", "singular value of the Jacobian of the residual, parameters in units of their bounds"),
    ("step", "1", "step of the calibration: one parameter after the other (OP_1, ...), then joint"),
    ("cost", "1", "half the sum of squares of the fit (eq:nonlinlsq), at the end of the step"),
    ("iterations", "1", "iterations of the step"),
    ("evaluations", "1", "simulations of all drives in the step"),
    ("stopped", "1", "why the step ended"),
    ("step_value", "", "value of the parameter at the end of the step, in its SI unit"),
    ("step_nrmse", "1", "nrmse at the end of the step"),
    ("initial_nrmse", "1", "nrmse before calibration"),
    ("iteration_step", "1", "step that the iteration belongs to"),
    ("iteration_cost", "1", "half the sum of squares of the fit after the iteration"),
    ("iteration_value", "", "value of the parameter after the iteration, in its SI unit"),
    ("restart_cost", "1", "half the sum of squares of the fit where a joint search from another start ended"),
    ("restart_value", "", "value of the parameter where a joint search from another start ended, in its SI unit"),
    ("profile", "1", "parameter that is held at one value after another"),
    ("profile_value", "", "value at which the parameter is held, in its SI unit"),
    ("profile_cost", "1", "half the sum of squares of the fit, all other parameters fitted anew"),
    ("rung", "1", "model on the error ladder"),
    ("site", "1", "name of the site"),
    ("group", "1", "drives that are fitted, or held out"),
    ("starts", "1", "whether searches from several starts agree"),
    ("floor_known", "1", "how the noise floor is known"),
    ("pair", "1", "pair of methods that are compared"),
    ("bound", "1", "estimate, or lower or upper end of its interval"),
    ("measure", "1", "comfort measure"),
    ("factor", "1", "factor of the samples"),
    ("scheme", "1", "way to draw samples"),
    ("size", "1", "runs of the smaller design"),
    ("place", "1", "name of the site"),
    ("round", "1", "round of the search"),
    ("effect", "1", "effect that was tested"),
    ("p_value", "1", "p-value of the effect over the whole library, by the score test"),
    ("gain", "1", "fall of twice the negative log-likelihood with the effect, by the score test"),
    ("absorbed", "1", "share of what the effect does that calibration takes up"),
    ("passed_over", "1", "why the effect was not tested, refitted or judged"),
    ("trial", "1", "refit of an effect"),
    ("trial_round", "1", "round of the refit"),
    ("trial_effect", "1", "effect that was refitted"),
    ("trial_sizes", "1", "sizes of the refit"),
    ("trial_gain", "1", "fall of twice the negative log-likelihood with the refit"),
    ("trial_bic", "1", "fall of the Bayesian information criterion with the refit"),
    ("trial_held_out_gain", "1", "fall of twice the negative log-likelihood on held-out drives"),
    ("trial_held_out_z", "1", "z of the gain on held-out drives (Vuong 1989)"),
    ("trial_share", "1", "share of the explainable error removed on fitted drives"),
    ("trial_held_out_share", "1", "share of the explainable error removed on held-out drives"),
    ("trial_correlation", "1", "canonical correlation of what the effect does with what the accepted one does"),
    ("trial_objection", "1", "why the refit was not accepted"),
    ("other_effect", "1", "effect that was not accepted"),
    ("other_parameter", "1", "size of an effect that was not accepted"),
    ("other_unit", "1", "unit of the size"),
    ("other_size", "", "the size by one step of least squares beside the last model, in other_unit, its unit"),
    ("other_interval", "", "90 % interval of the size, in other_unit, its unit"),
    ("other_plausible", "", "what is plausible of the size, in other_unit, its unit"),
    ("winner", "1", "effect that the round accepted"),
    ("cluster", "1", "effects that are not told from the accepted one"),
    ("decoy_p_value", "1", "smallest p-value of the decoys"),
    ("model", "1", "model of the search: calibrated, then with the effect that a round accepted; the last without those that it does without"),
    ("held_out", "1", "name of the held-out drive"),
    ("mean_square", "", "mean square error on fitted drives, in the unit of the signal squared"),
    ("held_out_mean_square", "", "mean square error on held-out drives, in the unit of the signal squared"),
    ("floor_mean_square", "", "mean square of the floor on fitted drives, in the unit of the signal squared"),
    ("held_out_floor_mean_square", "", "mean square of the floor on held-out drives, in the unit of the signal squared"),
    ("interval", "", "90 % interval of the parameter, in its SI unit"),
    ("shared_z", "1", "how surely repeats shared an error before the first effect, as a z"),
    ("shared_gone", "1", "share of what repeats had in common before the first effect that is gone"),
    ("remaining", "1", "share of the white error that repeats have in common after the last effect"),
    ("remaining_z", "1", "how surely repeats share an error after the last effect, as a z"),
    ("smoothness", "1", "the road between its points by the drives: 0 as by cubic interpolation, 1 as by linear, beyond it smoother still"),
    ("seen", "1", "what a missing force may depend on"),
    ("seen_at", "", "knots of the curve of a missing force, in seen_unit, its unit"),
    ("seen_unit", "1", "unit of what the missing force may depend on"),
    ("seen_axis", "1", "meaning of what the missing force may depend on"),
    ("seen_share", "1", "share of the white error that the curve takes"),
    ("missing", "", "what the model lacks, in missing_unit, its unit"),
    ("missing_error", "", "standard error of what the model lacks, in missing_unit, its unit"),
    ("named_missing", "", "what would show were the named effects the truth, in missing_unit, its unit"),
    ("missing_what", "1", "what it is that the model lacks"),
    ("missing_unit", "1", "unit of what the model lacks"),
    ("axle", "1", "front or rear axle"),
)

SIGNALS = ("a_x", "a_y", "a_z", "roll_rate", "pitch_rate", "yaw_rate")
"""The signals that model and measurement are compared in (tab:quantities)."""

DRIVE = ("v_x", *SIGNALS, "s", "e")
"""What every drive holds, measured or simulated, over ``time``."""

CALIBRATED = (
    "spring_stiffness_front",
    "spring_stiffness_rear",
    "tyre_friction",
    "tyre_radial_stiffness",
    "tyre_radial_damping",
)
"""The five parameters of the paper's calibration, in the order OP_1 to OP_5 (tab:constraints)."""

STANDARD_GRAVITY = 9.80665
"""m/s2; ISO 80000-3."""

AIR_DENSITY = 1.2
"""kg/m3 at 20 degrees and sea level."""


def describe(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with unit and long name written on every variable that the study knows.

    Attributes that a variable already carries stay as they are.
    """
    for name, variable in dataset.variables.items():
        known = VARIABLES.get(name)
        if known is None:
            continue
        if known.unit and variable.dtype.kind not in "USO":
            variable.attrs.setdefault("units", known.unit)
        variable.attrs.setdefault("long_name", known.long_name)
        if known.standard_name:
            variable.attrs.setdefault("standard_name", known.standard_name)
    return dataset
