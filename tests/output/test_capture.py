"""Which frames a capture takes, and measurements as JSON."""

from __future__ import annotations

import json
import math

import pytest

from viewer import Curve
from viewer.engine.fields import ParameterError
from viewer.output.capture import parse_frames
from viewer.output.measure import as_json


@pytest.mark.parametrize(("text", "frames"), [
    ("0", [0]), ("0,30,60", [0, 30, 60]), ("60,0,30,0", [0, 30, 60]), ("0:5", [0, 1, 2, 3, 4]), ("0:9:4", [0, 4, 8]),
    ("7,0:3", [0, 1, 2, 7]), ("6:0:-3", [3, 6]), (" 4 , 5 ", [4, 5]),
])
def test_frames_are_lists_and_ranges(text: str, frames: list[int]) -> None:
    """Each once, in rising order; a range leaves its end out."""
    assert parse_frames(text) == frames


@pytest.mark.parametrize("text", [
    "", "abc", "5:1", "-3", "-3:2", "0,,1", "1.5", "0:10:0", "0:1:2:3", ":", "3:3", "0:99999999999999999999",
    "0:2000000", "9" * 12, "9" * 400, "9" * 5000, "0x10", "nan"])
def test_other_frames_are_refused(text: str) -> None:
    """With what would be right, in a line that one can read."""
    with pytest.raises(ParameterError, match=r"^frames = .* is not a list such as 0,30,60 or a range") as refused:
        parse_frames(text)
    assert len(str(refused.value)) < 200


def test_measurements_are_plain_json() -> None:
    """Numbers as they are, curves by name, and null where a number is none."""
    read = json.loads(as_json({"vertices": 12, "angle": 0.5, "odd": math.inf,
                               "curve": Curve("epsilon", [1, 2], {"forward": [0.5, math.nan]})}))
    assert read == {"vertices": 12, "angle": 0.5, "odd": None, "curve": {"epsilon": [1.0, 2.0], "forward": [0.5, None]}}
