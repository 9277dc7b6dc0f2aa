"""Parameters over a life: declared, set, refused, stored, and described."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from tests.conftest import ScenePack
from viewer import ParameterError, Parameters, curve, formula, gradient, slider
from viewer.cli import main
from viewer.engine.catalog import Catalog
from viewer.engine.life_fields import GradientField, LifeCurveField
from viewer.kit.gradient import Gradient
from viewer.kit.life_curve import LifeCurve

SCENE = '''
from viewer import Parameters, Scene, Studio, curve, gradient

class Ember(Scene):
    """Something that glows and fades."""

    class Params(Parameters):
        size = curve("0:0, 0.2:1, 1:0", 0.0, 2.0, "Its size", unit="m", group="Look")
        glow = gradient("0:#ffffff, 1:#300000", "Its colour", group="Look")

    studio = Studio(ground=None)

    def draw(self):
        pass

    def measure(self):
        return {"middle": self.params.size(0.5), "red": self.params.glow.linear(1.0)[0]}

    def __init__(self, gpu, params):
        self.params = params
'''


class Ember(Parameters):
    """One parameter of each of the two kinds."""

    size = curve("0:0, 0.2:1, 1:0", 0.0, 2.0, "Its size", unit="m")
    glow = gradient("0:#ffffff, 1:#300000", "Its colour")


@pytest.mark.parametrize("value", ["0:2, 1:0.5", LifeCurve.parse("0:2, 1:0.5"), [(0, 2), (1, 0.5)],
                                   np.array([[0, 2], [1, 0.5]])])
def test_a_curve_is_taken_in_every_spelling(value: object) -> None:
    params = Ember({"size": value})
    assert params.size == LifeCurve(((0.0, 2.0), (1.0, 0.5)))
    assert params.stored()["size"] == "0:2, 1:0.5"


@pytest.mark.parametrize("value", ["0:#ff0000, 1:#000000", Gradient.parse("0:#ff0000, 1:#000000"),
                                   [(0, "#ff0000"), (1, (0, 0, 0))]])
def test_a_gradient_is_taken_in_every_spelling(value: object) -> None:
    params = Ember({"glow": value})
    assert params.glow == Gradient(((0.0, (1.0, 0.0, 0.0)), (1.0, (0.0, 0.0, 0.0))))
    assert params.stored()["glow"] == "0:#ff0000, 1:#000000"


@pytest.mark.parametrize(("name", "value", "message"), [
    ("size", "0:3", "size = 0:3 has the value 3, which is outside 0 to 2"),
    ("size", [(0, 1), (0.5, -1)], "size = [(0, 1), (0.5, -1)] has the value -1, which is outside 0 to 2"),
    ("size", [(0, math.nan)], "size = [(0, nan)] has the value nan, which is not a finite number"),
    ("size", "0:inf", "size = 0:inf has the value inf, which is not a finite number"),
    ("size", "1.5:1", "size = 1.5:1 has the position 1.5, which is outside 0 to 1"),
    ("size", "", "size = is empty; allowed: 1 to 16 such as 0:0, 0.2:1, 1:0"),
    ("size", "big", "size = big has the value big, which is not a number; write it like 0:0, 0.2:1, 1:0"),
    ("size", None, "size = None is not a list such as 0:0, 0.2:1, 1:0"),
    ("glow", "0:orange", "glow = 0:orange has the colour orange, which is not written like #ff8800"),
    ("glow", ",".join(f"{x / 20}:#ffffff" for x in range(13)),
     "glow = 0.0:#ffffff,0.05:#ffffff,0.1:#ffffff,0.15:#ffffff,0.2:#ff... has 13 entries; at most 12 are allowed"),
])
def test_what_is_wrong_is_told_and_changes_nothing(name: str, value: object, message: str) -> None:
    params = Ember()
    before = params.stored()
    with pytest.raises(ParameterError) as caught:
        params.set(name, value)
    assert str(caught.value) == message
    assert params.stored() == before


def test_a_wrong_declaration_is_told() -> None:
    with pytest.raises(ParameterError, match=r"a range from 1.0 to 1.0 holds no curve"):
        LifeCurveField("0:1", 1.0, 1.0, "")
    with pytest.raises(ParameterError, match="outside 0 to 1"):
        LifeCurveField("0:2", 0.0, 1.0, "")
    with pytest.raises(ParameterError, match="is not written like"):
        GradientField("orange", "")


def test_a_formula_takes_no_curve() -> None:
    with pytest.raises(ParameterError, match="size is a curve; a formula takes numbers only"):
        class Wrong(Parameters):
            size = curve("0:1", 0.0, 1.0, "Its size")
            speed = slider(1.0, 0.0, 2.0, "How fast")
            path = formula("size*speed", "Where it goes")
        Wrong()


def test_shaders_get_nothing_of_them() -> None:
    assert Ember().uniforms() == {}


def test_they_are_compared_by_what_they_mean() -> None:
    params = Ember()
    assert not params.update({"size": " 0:0,0.20:1 , 1:0", "glow": [(0, (1, 1, 1)), (1, "#300000")]})
    assert params.is_default("size")
    assert params.update({"size": "0:1"}) == {"size"}
    assert params.reset("size") == {"size"}
    assert params.size == LifeCurve.parse("0:0, 0.2:1, 1:0")


def test_random_values_survive_text_and_json() -> None:
    random = np.random.default_rng(8)
    for _ in range(200):
        x = np.unique(random.random(random.integers(1, 13)))
        size = LifeCurve(tuple(zip(x.tolist(), (2.0 * random.random(len(x))).tolist(), strict=True)))
        glow = Gradient(tuple((at, tuple(random.random(3).tolist())) for at in x.tolist()))
        stored = json.loads(json.dumps(Ember({"size": size, "glow": glow}).stored()))
        again = Ember(stored)
        assert (again.size, again.glow) == (size, glow)
        assert Ember.declared["size"].text(size) == stored["size"]


def test_the_command_line_lists_and_takes_them(scene_pack: ScenePack, capsys: pytest.CaptureFixture[str]) -> None:
    pack = scene_pack(ember=SCENE)
    about = Catalog([pack]).find("ember").describe()["parameters"]
    assert main(["list", "--json", "--pack", str(pack)]) == 0
    listed = next(scene for scene in json.loads(capsys.readouterr().out) if scene["name"] == "ember")["parameters"]
    assert listed == about
    assert listed[0] == {"name": "size", "kind": "curve", "default": "0:0, 0.2:1, 1:0", "unit": "m",
                         "help": "Its size", "rebuild": False, "group": "Look", "when": "",
                         "minimum": 0.0, "maximum": 2.0, "most_points": 16}
    assert (listed[1]["kind"], listed[1]["default"], listed[1]["most_stops"]) == (
        "gradient", "0:#ffffff, 1:#300000", 12)
    assert main(["measure", "ember", "--pack", str(pack), "--set", "size=0:0, 1:2", "--set", "glow=#ff0000"]) == 0
    measured = json.loads(capsys.readouterr().out)
    assert measured["middle"] == pytest.approx(1.0)
    assert measured["red"] == pytest.approx(1.0)
    assert main(["measure", "ember", "--pack", str(pack), "--set", "size=0:0, 0:2"]) == 2
    assert "size = 0:0, 0:2 has the position 0 after 0" in capsys.readouterr().err
