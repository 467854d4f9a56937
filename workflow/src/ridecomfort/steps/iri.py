"""Classes of ride quality of a site by the IRI of its road at the speeds of the runs."""

from ridecomfort import store
from ridecomfort.comfort import iriclass
from ridecomfort.errors import InputError
from ridecomfort.road import wheeltracks
from ridecomfort.steps.command import Command


def main(shards, road, config, output):
    settings, surface = config["iri"], store.read(road, ["elevation"])
    try:
        wheeltracks.tracks(surface, settings["wheel_tracks"])
    except InputError as problem:
        raise InputError(f"{problem} (comfort: iri: wheel_tracks in config/study.yaml)", file=road) from None
    found = iriclass.evaluate(
        (store.read(shard, ["v_x"]) for shard in shards),
        surface,
        edges=iriclass.Edges(settings["speed_km_h"], settings["thresholds"]),
        length=config["critical_length"],
        resolution=settings["segment"],
        wheel_tracks=settings["wheel_tracks"],
        moving_average=settings["moving_average"],
        sliding=config["sections"] == "sliding",
    )
    title = "Ride quality by the IRI at the speed driven"
    store.write(found, output, title=title, configuration=config, seed=store.seed(shards[0]))


if __name__ == "__main__":
    Command(main, inputs=("shards", "road"), many=("shards",)).run()
