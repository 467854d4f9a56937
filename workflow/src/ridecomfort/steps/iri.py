"""Classes of ride quality of a site by the IRI of its road at the speeds of the runs."""

from ridecomfort import store
from ridecomfort.comfort import iriclass
from ridecomfort.steps.command import Command


def main(shards, road, config, output):
    settings = config["iri"]
    found = iriclass.evaluate(
        (store.read(shard, ["v_x"]) for shard in shards),
        store.read(road, ["elevation"]),
        edges=iriclass.Edges(settings["speed_km_h"], settings["thresholds"]),
        length=config["critical_length"],
        resolution=settings["segment"],
        wheel_tracks=settings["wheel_tracks"],
        moving_average=settings["moving_average"],
        sliding=config["sections"] == "sliding",
    )
    store.write(found, output, title="Ride quality by the IRI at the speed driven", configuration=config)


if __name__ == "__main__":
    Command(main, inputs=("shards", "road"), many=("shards",)).run()
