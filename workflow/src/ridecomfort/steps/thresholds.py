"""Critical sections of a site by thresholds of acceleration, with those of jerk beside them."""

from ridecomfort import store
from ridecomfort.comfort import jerk, limits, thresholds
from ridecomfort.steps.command import Command


def main(shards, config, output):
    accepted, length, sliding = config["thresholds"], config["critical_length"], config["sections"] == "sliding"
    signals = (store.read(shard, list(accepted)) for shard in shards)
    found = thresholds.evaluate(signals, accepted, length, sliding=sliding)
    manoeuvres = (store.read(shard, ["v_x", "a_x", "a_y"]) for shard in shards)
    shaken = jerk.evaluate(manoeuvres, limits.jerk_bands(config["jerk"]), length, sliding=sliding)
    store.write(
        found.merge(shaken, compat="identical"),
        output,
        title="Critical sections by thresholds of acceleration and jerk",
        configuration=config,
        seed=store.seed(shards[0]),
    )


if __name__ == "__main__":
    Command(main, inputs=("shards",), many=("shards",)).run()
