"""Parameters: what each kind takes and refuses, their three spellings, and changes that are all or nothing."""

from __future__ import annotations

import json
import math
import random
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from viewer import (
    ParameterError,
    Parameters,
    choice,
    color,
    file,
    formula,
    integer,
    interval,
    slider,
    text,
    toggle,
)
from viewer.engine.fields import Field
from viewer.engine.number_fields import Interval, Slider
from viewer.engine.params import formula_uniform
from viewer.kit.formula import parse

KINDS = ("slider", "integer", "toggle", "choice", "color", "text", "formula", "file", "interval")


class Everything(Parameters):
    """One parameter of each kind, and one on decades."""

    amplitude: float = slider(0.05, 0.0, 0.5, "Ripple height", unit="radii")
    epsilon: float = slider(1e-3, 1e-7, 1.0, "Distance", logarithmic=True)
    count: int = integer(12, 1, 10_000, "How many", rebuild=True)
    shown: bool = toggle(True, "Whether it shows")
    direction: str = choice("normal", {"x": "Along x", "normal": "Along the normal"}, "Which way")
    tint: tuple[float, float, float] = color("#d8572a", "Its colour")
    caption: str = text("hello", "What it says", longest=20)
    displacement = formula("amplitude*cos(x)", "How far")
    model = file(None, "A mesh", suffixes=(".glb", ".gltf"))
    lifetime: tuple[float, float] = interval((1.0, 2.5), 0.0, 10.0, "How long", unit="s")


def field(name: str) -> Field[Any]:
    return Everything.declared[name]


def random_value(kind: str, chance: random.Random, folder: Path) -> object:
    """A value that a parameter of ``Everything`` of this kind takes."""
    if kind == "slider":
        return struct.unpack("f", struct.pack("f", chance.uniform(0.0, 0.5)))[0]
    if kind == "integer":
        return chance.randint(1, 10_000)
    if kind == "toggle":
        return chance.random() < 0.5
    if kind == "choice":
        return chance.choice(["x", "normal"])
    if kind == "color":
        return tuple(chance.randrange(256) / 255 for _ in range(3))
    if kind == "text":
        return "".join(chance.choices("aZ 09äß€=,;#\"'\\", k=chance.randrange(20)))
    if kind == "formula":
        return f"{chance.randrange(1, 9)}*sin({chance.choice('xyzt')})+{chance.random():.4f}"
    if kind == "file":
        path = folder / f"{chance.randrange(9)}.glb"
        path.touch()
        return chance.choice([path, None])
    return tuple(sorted(round(chance.uniform(0.0, 10.0), 6) for _ in range(2)))


def test_every_kind_is_here() -> None:
    """This file tests all nine."""
    assert {field.kind for field in Everything.declared.values()} == set(KINDS)


@pytest.mark.parametrize("kind", KINDS)
def test_spellings_read_back(kind: str, tmp_path: Path) -> None:
    """A value's text, and what a preset holds of it even after JSON, mean the same value."""
    chance = random.Random(kind)
    one = next(field for field in Everything.declared.values() if field.kind == kind)
    for _ in range(100):
        value = one.parse(random_value(kind, chance, tmp_path))
        stored = one.stored(value)
        for spelling in (one.text(value), stored, json.loads(json.dumps(stored))):
            again = one.parse(spelling)
            assert one.stored(again) == stored or one.stored(again) == pytest.approx(stored, rel=1e-8)
            assert type(again) is type(value)


@pytest.mark.parametrize("end", [1 / 3, 2 / 3, 0.1 + 0.2, 1e-7 / 3, 123456789.123456789])
def test_text_of_a_limit_stays_inside(end: float) -> None:
    """Rounding for display never makes a value that is then refused."""
    ends = sorted((end, 1.0))
    for number in ends:
        one = Slider(number, *ends, "")
        assert one.parse(one.text(number)) == pytest.approx(number, rel=1e-8)
        pair = Interval((number, number), *ends, "")
        assert pair.parse(pair.text((number, number))) == pytest.approx((number, number), rel=1e-8)


@pytest.mark.parametrize(("name", "value", "expected"), [
    ("amplitude", "0.1", 0.1), ("amplitude", 0, 0.0), ("amplitude", " 5e-1 ", 0.5),
    ("amplitude", np.float32(0.25), 0.25),
    ("count", "12", 12), ("count", 3.0, 3), ("count", np.int64(7), 7), ("count", "1e3", 1000),
    ("shown", "off", False), ("shown", "YES", True), ("shown", 0, False), ("shown", np.True_, True),
    ("direction", " x ", "x"),
    ("tint", "#ff0000", (1.0, 0.0, 0.0)), ("tint", "0, 0.5, 1", (0.0, 0.5, 1.0)), ("tint", [0, 1, 0], (0.0, 1.0, 0.0)),
    ("lifetime", "2..3", (2.0, 3.0)), ("lifetime", "4", (4.0, 4.0)), ("lifetime", 4, (4.0, 4.0)),
    ("lifetime", [0, 10], (0.0, 10.0)), ("model", "", None), ("model", None, None),
])
def test_values_and_texts_are_taken(name: str, value: object, expected: object) -> None:
    """Python values of the kind and what one types mean the same."""
    params = Everything()
    params.set(name, value)
    assert params.get(name) == expected
    assert getattr(params, name) == expected


@pytest.mark.parametrize(("name", "value", "message"), [
    ("amplitude", 9, "amplitude = 9 is outside 0 to 0.5"),
    ("amplitude", "9", "amplitude = 9 is outside 0 to 0.5"),
    ("amplitude", math.nan, "amplitude = nan is not a finite number; allowed: 0 to 0.5"),
    ("amplitude", "inf", "amplitude = inf is not a finite number; allowed: 0 to 0.5"),
    ("amplitude", "-inf", "amplitude = -inf is not a finite number; allowed: 0 to 0.5"),
    ("amplitude", "high", "amplitude = high is not a number; allowed: 0 to 0.5"),
    ("amplitude", "", "amplitude = is not a number; allowed: 0 to 0.5"),
    ("epsilon", 0, "epsilon = 0 is outside 1e-07 to 1"),
    ("count", 2.5, "count = 2.5 is not a whole number; allowed: 1 to 10000"),
    ("count", 0, "count = 0 is outside 1 to 10000"),
    ("shown", "perhaps", "shown = perhaps is neither true nor false"),
    ("direction", "norml", "direction = norml is not one of x, normal; did you mean normal?"),
    ("tint", "#ff00", "tint = #ff00 is not a colour such as #ff8800 or 1,0.53,0"),
    ("caption", "two\nlines", "caption = two lines is not one line of at most 20 characters"),
    ("caption", "x" * 21, f"caption = {'x' * 21} is not one line of at most 20 characters"),
    ("displacement", "sine(x)", "displacement: unknown function sine at 1; did you mean sin?"),
    ("displacement", "direction*x", "displacement: direction is a choice; a formula takes numbers only"),
    ("model", "/nowhere.glb", "model = /nowhere.glb is not a file that exists"),
    ("model", __file__, "does not end in .glb, .gltf"),
    ("lifetime", "3..2", "lifetime = 3..2 has its ends swapped: the smaller comes first"),
    ("lifetime", "1..2..3", "lifetime = 1..2..3 is not a range such as 0..10"),
    ("lifetime", "2...3", "lifetime = 2...3 is not a range such as 0..10"),
    ("lifetime", (1, 11), "lifetime = (1, 11) is outside 0 to 10"),
    ("amplitud", 0.1, "unknown parameter amplitud; did you mean amplitude?"),
    ("zzzzzz", 0.1, "unknown parameter zzzzzz"),
])
def test_refusals_say_what_is_allowed(name: str, value: object, message: str) -> None:
    """Each names the parameter and the value, in one line, and nothing changes."""
    params = Everything()
    before, revision = params.stored(), params.revision
    with pytest.raises(ParameterError) as refused:
        params.set(name, value)
    assert str(refused.value) == message or str(refused.value).endswith(message)
    assert "\n" not in str(refused.value)
    assert (params.stored(), params.revision) == (before, revision)


ODD_VALUES: list[object] = [
    None, True, [], {}, (), object(), b"1", 1j, [None], (math.nan, math.nan), ("a", "b", "c"), (10**400, 0, 0), 10**400,
    -1, "\0", "~nobody-of-that-name/mesh.glb", "x" * 100_000, "NaN", float, Exception("no"), np.zeros(3), np.array("x"),
]


@pytest.mark.parametrize("name", list(Everything.declared))
def test_nothing_odd_gets_through(name: str) -> None:
    """Whatever is not of the kind is a ParameterError of readable length; what is taken has the kind's type."""
    kinds = {"slider": float, "integer": int, "toggle": bool, "choice": str, "text": str}
    for value in ODD_VALUES:
        params = Everything()
        try:
            params.set(name, value)
        except ParameterError as error:
            assert len(str(error)) < 300
        else:
            assert isinstance(params.get(name), kinds.get(field(name).kind, object))
            json.dumps(params.stored(), allow_nan=False)


def test_update_is_all_or_nothing() -> None:
    """One bad value among good ones leaves every value as it was."""
    params = Everything()
    before = params.stored()
    with pytest.raises(ParameterError, match="count = many is not a number"):
        params.update({"amplitude": 0.4, "displacement": "k*x", "k": 3, "count": "many", "shown": False})
    assert params.stored() == before
    assert "k" not in params.fields
    assert params.update({"amplitude": 0.4, "shown": True}) == {"amplitude"}
    assert params.revision == 1


def test_assigning_checks_first() -> None:
    """``params.amplitude = 9`` is no way round the limits."""
    params = Everything()
    params.amplitude = 0.3
    with pytest.raises(ParameterError, match=r"is outside 0 to 0.5"):
        params.amplitude = 9
    assert params.amplitude == 0.3


@pytest.mark.parametrize("names", [["displacement", "k", "lift"], ["k", "lift", "displacement"]])
def test_a_name_in_a_formula_becomes_a_slider(names: list[str]) -> None:
    """It can be set along with its formula in any order, goes when unused, and comes back as it was."""
    values = {"displacement": "k*x + lift", "k": "2.5", "lift": -3}
    params = Everything()
    params.update({name: values[name] for name in names})
    assert list(params.fields)[-2:] == ["k", "lift"]
    assert (params.k, params.lift, params.field("k").kind) == (2.5, -3.0, "slider")
    assert params.numbers(params.displacement) == {"k": 2.5, "lift": -3.0}

    params.displacement = "k*x"
    assert params.k == 2.5
    assert "lift" not in params.fields
    with pytest.raises(ParameterError, match="unknown parameter lift"):
        params.get("lift")
    with pytest.raises(AttributeError):
        _ = params.lift

    params.displacement = "x"
    with pytest.raises(ParameterError, match="unknown parameter k"):
        params.set("k", 1)
    params.displacement = "lift + k*x"
    assert (params.k, params.lift) == (2.5, -3.0)


def test_a_formula_takes_declared_numbers() -> None:
    """Sliders, integers and toggles are numbers to a formula, and follow their own limits."""
    params = Everything({"displacement": "amplitude*count + shown"})
    assert params.numbers(params.displacement) == {"amplitude": 0.05, "count": 12.0, "shown": 1.0}
    assert list(params.fields) == list(Everything.declared)
    assert params.uniforms()["u_displacement_count"] == 12.0


def test_uniforms_are_what_shaders_get() -> None:
    """Choices as an index, colours in linear light, and nothing for text and files."""
    uniforms = Everything({"direction": "normal", "tint": "#ff8000"}).uniforms()
    assert uniforms["u_direction"] == 1
    assert uniforms["u_tint"] == pytest.approx((1.0, ((128 / 255 + 0.055) / 1.055) ** 2.4, 0.0))
    assert uniforms["u_lifetime"] == (1.0, 2.5)
    assert not {"u_caption", "u_model", "u_displacement"} & set(uniforms)


def test_reset_and_is_default() -> None:
    """Every parameter starts as its default and can go back, one by one or all."""
    params = Everything()
    assert all(params.is_default(name) for name in params.fields)
    params.update({"amplitude": 0.2, "displacement": "k*x", "k": 7, "lifetime": "3..4"})
    assert [name for name in params.fields if not params.is_default(name)] == [
        "amplitude", "displacement", "lifetime", "k"]
    assert params.reset("k") == {"k"}
    assert params.k == 1.0
    assert params.reset() == {"amplitude", "displacement", "lifetime"}
    assert params.stored() == Everything().stored()


def test_setting_what_is_already_there_changes_nothing() -> None:
    """No revision, so no rebuild, for any kind."""
    params = Everything()
    assert params.update(dict(params.stored())) == frozenset()
    assert params.update({name: one.default for name, one in Everything.declared.items()}) == frozenset()
    assert params.revision == 0


def test_two_instances_share_nothing() -> None:
    """One stage's values are not another's."""
    one, other = Everything(seed=1), Everything()
    one.update({"amplitude": 0.5, "displacement": "k*x", "k": 9})
    assert (other.amplitude, other.displacement.text, one.seed, other.seed) == (0.05, "amplitude*cos(x)", 1, 0)
    assert "k" not in other.fields


def test_snapshot_restores_everything() -> None:
    """Values and formula-born sliders come back; shaders hear of it."""
    params = Everything({"displacement": "k*x", "k": 2})
    before, stored, revision = params.snapshot(), params.stored(), params.revision
    params.update({"displacement": "m*x", "m": 5, "amplitude": 0.1})
    params.restore(before)
    assert params.stored() == stored
    assert params.revision > revision


def test_description_is_complete_and_plain() -> None:
    """Everything about a parameter as JSON, without NaN, the default readable by ``parse``."""
    for name, one in Everything.declared.items():
        about = json.loads(json.dumps(one.describe(), allow_nan=False))
        assert {"name", "kind", "default", "unit", "help", "rebuild", "group", "when"} <= set(about)
        assert (about["name"], about["kind"], about["help"]) == (name, one.kind, one.help)
        assert one.stored(one.parse(about["default"])) == about["default"]
    assert field("amplitude").describe() == {
        "name": "amplitude", "kind": "slider", "default": 0.05, "unit": "radii", "help": "Ripple height",
        "rebuild": False, "group": "", "when": "", "minimum": 0.0, "maximum": 0.5, "logarithmic": False}
    assert field("direction").describe()["options"] == ["x", "normal"]
    assert field("model").describe()["suffixes"] == [".glb", ".gltf"]


def test_formulas_can_be_given_as_formulas() -> None:
    """A parsed formula, its text and a plain number all do."""
    params = Everything()
    params.displacement = parse("x^2")
    assert params.displacement.evaluate(x=np.array(3.0)) == 9.0
    params.displacement = 0.25
    assert params.displacement.text == "0.25"


def test_impossible_declarations_are_refused() -> None:
    """A default outside its range, an empty range, a name that ``Parameters`` needs itself."""
    with pytest.raises(ParameterError, match="default = 2 is outside 0 to 1"):
        slider(2, 0, 1, "")
    with pytest.raises(ParameterError, match="holds no numbers"):
        slider(1, 1, 1, "")
    with pytest.raises(ParameterError, match="holds no numbers"):
        slider(0.5, 0, 1, "", logarithmic=True)
    with pytest.raises(ParameterError, match="is not one of"):
        choice("red", ["green"], "")
    with pytest.raises(ParameterError, match="update cannot name a parameter"):
        type("Wrong", (Parameters,), {"update": slider(0, 0, 1, "")})


def test_names_that_glsl_reserves_get_uniforms_of_their_own() -> None:
    """Two underscores in a row are GLSL's own; no two names may share a uniform over it."""
    names = ["a_b", "a__b", "a_0_b", "_a", "a_", "__", "a"]
    uniforms = {formula_uniform("height", name) for name in names}
    assert len(uniforms) == len(names)
    assert not any("__" in uniform for uniform in uniforms)


def test_an_interval_may_be_an_array() -> None:
    params = Everything()
    params.lifetime = np.array([0.5, 1.5])  # type: ignore[assignment]
    assert params.lifetime == (0.5, 1.5)


class Grouped(Parameters):
    """Parameters under headings, some of which depend on others."""

    source: str = choice("formula", ["formula", "volume", "points"], "Where the field comes from")
    slice: str = choice("none", ["none", "x", "y"], "Where to cut", group="View", when="source!=points")
    depth: float = slider(0.0, -1.0, 1.0, "How far in", group="View", when="slice!=none, source = formula|volume")
    walk: bool = toggle(False, "Go from cell to cell", group="Cells")
    pause: bool = toggle(False, "Stand still", group="Cells", when="walk")
    height = formula("lift*x", "How high", group="Field", when="source=formula")
    bend = formula("lift*y", "How bent", group="Bend", when="!walk")


@pytest.mark.parametrize(("values", "active"), [
    ({}, {"source", "slice", "walk", "height", "bend", "lift"}),
    ({"slice": "x"}, {"source", "slice", "depth", "walk", "height", "bend", "lift"}),
    ({"slice": "x", "source": "volume", "walk": True}, {"source", "slice", "depth", "walk", "pause"}),
    ({"slice": "x", "source": "points"}, {"source", "walk", "bend", "lift"}),
])
def test_conditions_follow_the_values(values: dict[str, object], active: set[str]) -> None:
    """Alternatives, negations and several conditions; a formula's own slider counts where one formula does."""
    params = Grouped(values)
    assert {name for name in params.fields if params.is_active(name)} == active


def test_what_has_no_effect_can_be_set_all_the_same() -> None:
    """A preset or an option may come before what gives it its effect."""
    params = Grouped({"source": "points"})
    params.update({"depth": 0.5, "pause": True})
    assert (params.depth, params.pause, params.is_active("depth")) == (0.5, True, False)
    with pytest.raises(ParameterError, match="unknown parameter dept; did you mean depth"):
        params.is_active("dept")


def test_groups_and_conditions_are_described() -> None:
    """As they were written; a formula's own slider stands where the first of its formulas does."""
    about = {name: one.describe() for name, one in Grouped().fields.items()}
    assert (about["depth"]["group"], about["depth"]["when"]) == ("View", "slice!=none, source = formula|volume")
    assert (about["source"]["group"], about["source"]["when"]) == ("", "")
    assert (about["lift"]["group"], about["lift"]["when"]) == ("Field", "source=formula")


@pytest.mark.parametrize(("when", "message"), [
    ("sorce=volume", "unknown parameter sorce; did you mean source?"),
    ("source=volum", "source = volum is not one of formula, volume; did you mean volume?"),
    ("source=volume|", "source = is not one of formula, volume"),
    ("source", "source is a choice and cannot stand alone; only a toggle can"),
    ("walk=true", "walk is a toggle; write walk or !walk"),
    ("size=1", "size is a slider; only choices and toggles decide about others"),
    ("walk,", "nothing is not of the form choice=option, choice!=option, toggle or !toggle"),
    ("walk and source", "walk and source is not of the form"),
    ("own", "unknown parameter own"),
])
def test_conditions_that_cannot_be_are_refused(when: str, message: str) -> None:
    """When the class is made, naming the parameter, the condition and what is wrong in it."""
    with pytest.raises(ParameterError) as refused:
        type("Wrong", (Parameters,), {
            "source": choice("formula", ["formula", "volume"], ""), "walk": toggle(False, ""),
            "size": slider(0, 0, 1, ""), "own": toggle(True, "", when=when)})
    assert str(refused.value).startswith(f"own: when = {when}: {message}")


def test_a_subclass_keeps_conditions_and_has_them_checked() -> None:
    """An option that it takes away can no longer be asked about."""
    More = type("More", (Grouped,), {"extra": toggle(True, "", when="walk")})
    assert not More().is_active("extra")
    assert not More().is_active("depth")
    with pytest.raises(ParameterError, match=r"slice: when = source!=points: source = points is not one of formula"):
        type("Fewer", (Grouped,), {"source": choice("formula", ["formula", "volume"], "")})
