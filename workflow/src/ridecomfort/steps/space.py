"""Bring a shard of simulated drives from time to space, with what ISO 2631-1 makes of them over time."""

import numpy as np

from ridecomfort import store
from ridecomfort.comfort import iso2631, quantities
from ridecomfort.comfort.doses import Doses
from ridecomfort.comfort.seat import Seat
from ridecomfort.errors import InputError
from ridecomfort.space import along, places, require_cover
from ridecomfort.steps.command import Command

VARIABLES = ("v_x", "a_x", "a_y", "a_z", "a_v")
KEPT_BITS = 10


def main(drives, road, config, output):
    u = store.read(road, ["u"])["u"].values
    s = places(u[0], u[-1], **config["space"], file=road)
    runs = store.read(drives, ["s", "v_x", "a_x", "a_y", "a_z"])
    weighting = config["iso2631"]
    averaging = weighting["time_constant"], weighting["averaging"]
    rate = 1.0 / float(runs["time"][1] - runs["time"][0])
    require_cover(runs, s)
    _check_run_in(runs, s[0], weighting, drives)
    doses = Doses(runs["s"].transpose("run", "time"), rate, s[0], s[-1], *averaging)
    runs["a_v"] = iso2631.running_total_value(
        runs["a_x"],
        runs["a_y"],
        runs["a_z"],
        rate,
        *averaging,
        weightings=tuple(weighting["weightings"]),
        factors=tuple(weighting["factors"]),
        before="mirror",
        seat=Seat(**weighting["seat"]) if weighting["seat"] else None,
        weighted=doses.weighted,
    )
    doses.vertical(runs["a_z"], before="mirror")
    in_space = along(runs, s, VARIABLES).merge(doses.dataset(runs["run"]))
    store.write(
        in_space,
        output,
        title=f"Simulated drives on {config['site']} over distance",
        configuration=config,
        seed=runs.attrs.get("seed"),
        keep_bits=KEPT_BITS,
    )


def _check_run_in(runs, start, weighting, file) -> None:
    """Raise InputError where a drive comes to the ``start`` (m) of what is evaluated before its running rms is known."""
    needed = quantities.SETTLED[weighting["averaging"]] * weighting["time_constant"]
    time, s = runs["time"].values, runs["s"].transpose("run", "time").values
    driven = min((float(time[np.argmax(each >= start)] - time[0]) for each in s if (each >= start).any()), default=needed)
    if driven < needed:
        raise InputError(
            f"a run-in is driven in {driven:.3g} s, expected {needed:g} s or more, after which the running rms is known "
            "(space: run_in and comfort: iso2631: time_constant, averaging in config/study.yaml)",
            file=file,
        )


if __name__ == "__main__":
    Command(main, inputs=("drives", "road")).run()
