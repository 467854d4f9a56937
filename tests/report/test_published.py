"""The published figures in the package are those of the paper."""

import pytest
import yaml

from ridecomfort.report import published


def test_equal_to_the_transcription_beside_the_checkout(shared):
    transcription = yaml.safe_load((shared / "paper" / "published.yaml").read_text(encoding="utf-8"))
    ours = {key: value for key, value in published.figures().items() if key != "misprints"}
    assert ours == transcription


@pytest.mark.parametrize("site, windows", [("ts1", 605), ("ts2", 319), ("ts3", 427)])
def test_shares_are_those_of_the_windows(site, windows):
    """tab:thresholding_table, tab:rid_comf_res, tab:rid_comf_res2: R_c = 100 C / windows to the digits printed."""
    assert published.windows(site) == windows
    detections = published.figures()["detections"]
    entries = [row for axis in detections["thresholding"].values() for row in axis.values()]
    entries += [*detections["iso2631"].values(), *detections["iri"].values()]
    for entry in entries:
        count, share = entry[site]
        assert share == pytest.approx(100 * count / windows, abs=0.011)


@pytest.mark.parametrize(
    "table, row, site, printed",
    [
        ("rid_comf_res", ("LU",), "ts1", (54, 8.92, 551, 91.08)),
        ("rid_comf_res", ("LU",), "ts2", (20, 6.27, 319, 93.73)),
        ("rid_comf_res", ("U",), "ts2", (8, 2.51, 311, 97.49)),
        ("rid_comf_res", ("FU",), "ts3", (6, 1.40, 427, 98.60)),
        ("rid_comf_res2", ("P",), "ts1", (0, 0.0, 0, 0.0)),
        ("rid_comf_res2", ("G",), "ts2", (68, 21.32, 251, 78.68)),
        ("thresholding_table", ("a_z", "ND"), "ts1", (194, 32.07, 411, 67.93)),
        ("thresholding_table", ("a_y", "AG"), "ts2", (1, 0.31, 318, 99.69)),
    ],
)
def test_rows_as_printed(table, row, site, printed):
    assert published.detection(table, row, site) == pytest.approx(printed, abs=0.006)


def test_misprints_contradict_the_windows_and_nothing_else_does():
    for table, rows in (("rid_comf_res", ("LU", "FU", "U", "VU", "EU")), ("rid_comf_res2", ("G", "F", "M", "P"))):
        for row in rows:
            for site in ("ts1", "ts2", "ts3"):
                count, _, rest, _ = published.detection(table, (row,), site)
                consistent = count + rest == published.windows(site)
                assert consistent == (published.misprinted(table, (row,), site) is None)


def test_what_the_paper_does_not_print_is_none():
    assert published.detection("thresholding_table", ("a_z", "PT"), "ts1") is None
    assert published.detection("rid_comf_res", ("LU",), "home") is None
    assert published.windows("home") is None
