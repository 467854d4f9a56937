"""Critical sections of a site by the comfort bands of ISO 2631-1, and the doses of its runs."""

import xarray as xr

from ridecomfort import store
from ridecomfort.comfort import doses, iso2631
from ridecomfort.steps.command import Command

KEPT_BITS = 10


def main(shards, config, output):
    spaces = (store.read(shard, ["a_v"]) for shard in shards)
    found = iso2631.evaluate(
        spaces, config["iso2631"]["bands"], config["critical_length"], sliding=config["sections"] == "sliding"
    )
    suffered = xr.concat([store.read(shard, doses.NAMES) for shard in shards], "run")
    store.write(
        found.merge(suffered),
        output,
        title="Critical sections by ISO 2631-1",
        configuration=config,
        seed=store.seed(shards[0]),
        keep_bits=KEPT_BITS,
    )


if __name__ == "__main__":
    Command(main, inputs=("shards",), many=("shards",)).run()
