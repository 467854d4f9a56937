"""Files of comma-separated values: a table as it is written, or one line that says what is wrong with it."""

from __future__ import annotations

import pytest

from ridecomfort import csvtable
from ridecomfort.errors import InputError

ROWS = "a, b\n1, 2\n\n3, 4\n"


def write(tmp_path, text):
    path = tmp_path / "table.csv"
    path.write_text(text)
    return path


def test_names_lose_the_blanks_before_them_and_blank_lines_are_no_rows(tmp_path):
    path = write(tmp_path, ROWS)
    table = csvtable.read(path)
    assert table.to_dict("list") == {"a": [1, 3], "b": [2, 4]}
    assert csvtable.names(path) == ["a", "b"] and csvtable.line_of(path, 1) == 4


def test_the_first_rows_alone_are_read_where_that_is_asked(tmp_path):
    assert csvtable.read(write(tmp_path, ROWS), rows=0).columns.tolist() == ["a", "b"]


@pytest.mark.parametrize("text, said", [
    ("a,b\n1,2,\n3,4,\n", "line 2: 3 fields, expected one for each of the 2 names of columns"),
    ("a,b\n0,2,3\n1,4,5\n", "line 2: 3 fields"),
    ("a,b\n1,2\n3,4,5\n", "Expected 2 fields in line 3, saw 3"),
    ("a;b\n1,5;2\n", "line 1: one column only: separated by ';'"),
    ("", "not a readable CSV file"),
])  # fmt: skip
def test_what_is_no_table_is_refused_by_line(tmp_path, text, said):
    path = write(tmp_path, text)
    with pytest.raises(InputError, match=said) as refused:
        csvtable.read(path)
    assert str(path) in str(refused.value) and "\n" not in str(refused.value)


def test_bytes_that_are_no_text_are_refused(tmp_path):
    (tmp_path / "table.csv").write_bytes(b"\xff\xfe\x00a,b\n")
    with pytest.raises(InputError, match="not a readable CSV file"):
        csvtable.read(tmp_path / "table.csv")


def test_a_file_that_is_not_there_is_said_so(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        csvtable.read(tmp_path / "table.csv")
