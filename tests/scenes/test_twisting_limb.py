"""The twisting limb against the laws of skinning, libigl, dual-quaternions and real rigged models."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import igl
import numpy as np
import pytest
from dual_quaternions import DualQuaternion

from tests.conftest import MakeStage
from viewer import DemoscopeError, cli
from viewer.engine.annotations import Click, Handle
from viewer.engine.stage import Stage
from viewer.kit import quaternion, skinning
from viewer.kit.gltf import read_model

pytestmark = pytest.mark.usefixtures("context")
MODELS = Path(__file__).parents[3] / "shared" / "models"
with_models = pytest.mark.skipif(not MODELS.is_dir(), reason="the rigged models are not here")
FILES = ("SimpleSkin.gltf", "RiggedSimple.glb", "Fox.glb")


def measured(capsys: pytest.CaptureFixture[str], **values: object) -> dict[str, Any]:
    """What the command line measures."""
    words = [word for name, value in values.items() for word in ("--set", f"{name}={value}")]
    assert cli.main(["measure", "twisting_limb", *words]) == 0
    read: dict[str, Any] = json.loads(capsys.readouterr().out)
    return read


@pytest.fixture
def stage(make_stage: MakeStage) -> Stage:
    """The scene, small."""
    return make_stage("", name="twisting_limb", size=(160, 90))


@pytest.mark.parametrize(("twist_bones", "expected"), list(enumerate([0.0, 0.707, 0.866, 0.924, 0.951])))
def test_extra_bones_widen_the_waist(capsys: pytest.CaptureFixture[str], twist_bones: int, expected: float) -> None:
    """Half a turn: nothing is left without, then more and more."""
    read = measured(capsys, twist=180, twist_bones=twist_bones)
    assert read["min_radius_ratio"] == pytest.approx(expected, abs=0.02)
    assert read["bones"] == 3 + twist_bones and read["influences"] == 2 and read["unnormalised_vertices"] == 0


def test_the_waist_the_volume_and_dual_quaternions(capsys: pytest.CaptureFixture[str]) -> None:
    """The closed forms for half a turn, and for 150 degrees."""
    read = measured(capsys, twist=180, twist_bones=0)
    assert read["volume_ratio"] == pytest.approx(1.0 / 3.0, abs=0.01) and 0.3 < read["area_ratio"] < 0.7
    assert measured(capsys, twist=150)["min_radius_ratio"] == pytest.approx(0.259, abs=0.005)
    rigid = measured(capsys, twist=180, method="dual_quaternion")
    assert rigid["min_radius_ratio"] == pytest.approx(1.0, abs=0.001)
    assert rigid["volume_ratio"] == pytest.approx(1.0, abs=0.005)


def test_the_curves_bring_their_law_along(capsys: pytest.CaptureFixture[str]) -> None:
    """Measured on the GPU, they lie on it: along the limb, and for all twists, also beyond half a turn."""
    read = measured(capsys, twist=200, twist_bones=1)
    for name, axis, points in (("radius_along_limb", "along", 100), ("radius_vs_twist", "twist", 49)):
        curve = read[name]
        assert set(curve) == {axis, "measured", "law"} and len(curve[axis]) >= points
        assert np.allclose(curve["measured"], curve["law"], atol=2e-3)
    over = read["radius_vs_twist"]
    assert np.allclose(over["law"], np.abs(np.cos(np.radians(np.array(over["twist"]) / 4.0))))
    assert (over["twist"][0], over["twist"][-1]) == (-360.0, 360.0)


def test_the_comparison_is_in_the_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    """Three rows: thin, thicker, whole."""
    rows = measured(capsys, twist=180)["comparison"]
    assert [(row["method"], row["twist_bones"]) for row in rows] == [
        ("linear", 0), ("linear", 3), ("dual_quaternion", 0)]
    assert [row["min_radius_ratio"] for row in rows] == pytest.approx([0.0, 0.924, 1.0], abs=0.002)


@pytest.mark.parametrize("twist_bones", [0, 2])
def test_the_export_is_libigl_s_linear_blend(stage: Stage, twist_bones: int) -> None:
    """What the vertex shader computed, from the arrays that come along."""
    stage.set(twist=130, bend=40, twist_bones=twist_bones)
    mesh = stage.geometry()
    full = np.zeros((len(mesh["joints"]), len(mesh["matrices"])))
    np.add.at(full, (np.arange(len(full))[:, None], mesh["joints"]), mesh["weights"])
    stacked = np.concatenate([matrix[:3].T for matrix in mesh["matrices"]])
    expected = igl.lbs_matrix(mesh["rest_vertices"].astype(float), full) @ stacked
    assert np.abs(mesh["vertices"] - expected).max() < 1e-5
    names = ("rest_vertices", "joints", "weights", "matrices")
    assert np.abs(mesh["vertices"] - skinning.linear_blend(*(mesh[name] for name in names))).max() < 1e-5


def test_the_export_is_the_package_s_dual_quaternions(stage: Stage) -> None:
    """Every hundredth vertex of the arm, bent and twisted."""
    stage.set(twist=130, bend=40, method="dual_quaternion")
    mesh = stage.geometry()
    motions = [DualQuaternion.from_homogeneous_matrix(matrix) for matrix in mesh["matrices"]]
    arrays = np.array([motion.dq_array() for motion in motions])
    for vertex in range(0, len(mesh["vertices"]), 100):
        joints, weights = mesh["joints"][vertex], mesh["weights"][vertex]
        signs = np.where(arrays[joints, :4] @ arrays[joints[weights.argmax()], :4] < 0.0, -1.0, 1.0)
        blended = DualQuaternion.from_dq_array((signs * weights) @ arrays[joints]).normalized()
        assert np.allclose(blended.transform_point(mesh["rest_vertices"][vertex]), mesh["vertices"][vertex], atol=1e-5)


@with_models
@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("method", ["linear", "dual_quaternion"])
def test_real_models_animate_as_in_numpy(make_stage: MakeStage, name: str, method: str) -> None:
    """At several times, by the clip's own pose and the NumPy reference."""
    path = MODELS / name
    stage = make_stage("", name="twisting_limb", params={"model": str(path), "twist": 0, "method": method})
    model = read_model(path)
    blend = skinning.linear_blend if method == "linear" else skinning.dual_quaternion
    moved = []
    for frame in (0, 17, 60, 101):
        stage.seek(frame)
        mesh, clip = stage.geometry(), model.clips[0]
        skeleton = model.mesh.skeleton
        local = skeleton.local(*clip.pose(skeleton, (frame / 60.0) % clip.seconds))
        expected = blend(model.mesh.positions, model.mesh.joints, model.mesh.weights, model.mesh.palette(local))
        assert np.abs(mesh["vertices"] - expected).max() < 1e-5 * np.abs(expected).max()
        moved.append(mesh["vertices"])
    assert np.abs(moved[1] - moved[0]).max() > 1e-3 * np.abs(moved[0]).max()


@with_models
def test_the_fox_plays_each_of_its_animations(make_stage: MakeStage) -> None:
    """By name or number, at its speed; none is its pose at rest."""
    stage = make_stage("", name="twisting_limb", params={"model": str(MODELS / "Fox.glb"), "twist": 0})
    stage.seek(20)
    poses = {}
    for animation in ("Survey", "Walk", "Run", "1", "none"):
        stage.set(animation=animation)
        poses[animation] = stage.geometry()["vertices"]
    assert np.array_equal(poses["Walk"], poses["1"])
    for one, other in (("Survey", "Walk"), ("Walk", "Run"), ("Run", "none")):
        assert np.abs(poses[one] - poses[other]).max() > 1.0
    stage.set(animation="Walk", animation_speed=2.0)
    stage.seek(10)
    assert np.allclose(stage.geometry()["vertices"], poses["Walk"], atol=1e-3)
    with pytest.raises(DemoscopeError, match=r"animation = Wolk is none of .* Survey, Walk, Run; did you mean Walk\?"):
        stage.set(animation="Wolk")


@with_models
@pytest.mark.parametrize("name", FILES)
def test_a_model_of_one_s_own_twists_and_collapses(make_stage: MakeStage, name: str) -> None:
    """Where its skin blends, by the same law, and dual quaternions keep it."""
    stage = make_stage("", name="twisting_limb",
                       params={"model": str(MODELS / name), "twist": 170, "animation": "none"})
    read = stage.measure()
    curve = read["radius_along_limb"]
    assert np.allclose(curve.series["measured"], curve.series["law"], atol=5e-3)
    stage.set(method="dual_quaternion")
    assert stage.measure()["min_radius_ratio"] == pytest.approx(1.0, abs=1e-3)
    assert read["min_radius_ratio"] < 0.9


def test_a_model_that_cannot_be_read_leaves_the_last_one(stage: Stage, tmp_path: Path) -> None:
    """One line, and the same picture as before."""
    before = stage.pixels()
    broken = tmp_path / "broken.glb"
    broken.write_bytes(b"glTF" + bytes(30))
    for path, words in ((broken, "model .*broken.glb"), (tmp_path / "missing.glb", "is not a file that exists")):
        with pytest.raises(DemoscopeError, match=words) as caught:
            stage.set(model=str(path))
        assert "\n" not in str(caught.value)
    assert np.array_equal(stage.pixels(), before)


@pytest.mark.parametrize(("name", "value", "words"), [
    ("bone", "hant", r"bone = hant is none of the model's bones upper arm, forearm, hand; did you mean hand\?"),
    ("weights", "7", "weights = 7 is none of the model's bones"),
    ("pose", "hand 1 2 3", "pose = hand 1 2 3 is not written like hand: 0 0 35"),
    ("twist", "500", "twist = 500 is outside -360 to 360"), ("twist_bones", "9", "twist_bones = 9 is outside 0 to 8"),
])
def test_a_wrong_word_changes_nothing(stage: Stage, name: str, value: str, words: str) -> None:
    """It is told what is allowed."""
    before = stage.params.stored()
    with pytest.raises(DemoscopeError, match=words):
        stage.set(**{name: value})
    assert stage.params.stored() == before


def test_side_by_side_stand_the_three_with_their_numbers(stage: Stage) -> None:
    """Under each what it is called, how thin it is and what is left; alone there is one."""
    stage.resize((960, 540))
    stage.set(twist=180)
    stage.render()
    words = [label.text for label in stage.scene.labels()]
    assert [word for word in words if "thinnest" in word] == ["thinnest 0.00", "thinnest 0.92", "thinnest 1.00"]
    assert {"Linear blending", "3 extra bones", "Dual quaternions", "volume 33 %"} <= set(words)
    stage.set(view="single", method="linear", twist_bones=1)
    stage.render()
    assert [label.text for label in stage.scene.labels()][:2] == ["1 extra bone", "thinnest 0.71"]


def test_the_picture_tells_ways_of_skinning_apart(stage: Stage) -> None:
    """The waist is narrower in the left third than in the right one."""
    stage.resize((480, 270))
    stage.set(twist=180, show_slice=False, skin="plain", falloff="linear")
    picture = stage.pixels()[..., :3].astype(int)
    stage.set(twist=0)
    straight = stage.pixels()[..., :3].astype(int)
    changed = (np.abs(picture - straight).max(axis=2) > 25)[:220]
    columns = [int(part.sum()) for part in np.split(changed, 3, axis=1)]
    assert columns[0] > 1.3 * columns[2]


def test_weights_are_shown_as_colours(stage: Stage) -> None:
    """Of the twisted bone, or of any by its name; the scale says whose."""
    plain = stage.pixels()
    assert stage.color_scale() is None
    for value, bone in (("on", "hand"), ("forearm", "forearm"), ("0", "upper arm")):
        stage.set(weights=value)
        scale = stage.color_scale()
        assert scale and scale.title == f"weight of {bone}" and (scale.low, scale.high) == (0.0, 1.0)
        assert not np.array_equal(stage.pixels(), plain)
    stage.set(weights="off")
    assert np.array_equal(stage.pixels(), plain)


def test_a_click_on_a_joint_chooses_its_bone(stage: Stage) -> None:
    """The nearest one, in any of the three limbs; beside all of them nothing happens."""
    stage.resize((640, 360))
    stage.set(view="single", twist=0)
    stage.render()
    eye = stage.camera.eye
    for name, height in (("forearm", 0.78 - 1.06), ("hand", 1.54 - 1.06)):
        way = np.array([0.0, height, 0.0]) - eye
        click = Click((0.0, 0.0), eye, way / np.linalg.norm(way), 16 / 9, 90)
        assert stage.scene.click(click) == {"bone": name, "show_bones": True}
    sky = Click((0.0, 0.0), eye, np.array([0.0, 1.0, 0.0]), 16 / 9, 90)
    assert stage.scene.click(sky) == {}


def test_the_rings_turn_the_bone_and_twist_the_limb(stage: Stage) -> None:
    """About the limb's axis it is the twist, beside it the bone's own pose; where it is let go, there it stands."""
    assert stage.handle() is None
    stage.resize((640, 360))
    stage.set(show_bones=True, twist=20)
    stage.render()
    handle = stage.handle()
    assert handle and handle.name == "turn hand" and np.allclose(handle.matrix[:3, 3], [0.0, 0.5, 0.0], atol=0.03)
    turn = np.eye(4)
    turn[:3, :3] = quaternion.to_matrix(quaternion.from_axis_angle([0.0, 1.0, 0.0], 0.5))
    values = stage.dragged(Handle(np.block([[turn[:3, :3] @ handle.matrix[:3, :3], handle.matrix[:3, 3:]],
                                            [np.zeros((1, 3)), np.ones((1, 1))]]), handle.name))
    assert values["twist"] == pytest.approx(20 + np.degrees(0.5)) and values["pose"] == ""
    tilted = handle.matrix.copy()
    tilted[:3, :3] = quaternion.to_matrix(
        quaternion.from_rotation_vector([0.3, 0.2, 0.1])) @ handle.matrix[:3, :3]
    stage.update_params(stage.dragged(Handle(tilted, handle.name)))
    stage.render()
    after = stage.handle()
    assert after and np.allclose(after.matrix, tilted, atol=2e-4)
    assert "hand:" in stage.params.pose


def test_past_half_a_turn_dual_quaternions_say_what_they_do(stage: Stage) -> None:
    """They take the short way round; it is told, not hidden."""
    stage.set(twist=200)
    assert any("short way round" in remark for remark in stage.remarks())
    stage.set(twist=170)
    assert not stage.remarks()
    stage.set(twist=-90, method="dual_quaternion")
    short = stage.geometry()["vertices"]
    stage.set(twist=270)
    assert np.allclose(stage.geometry()["vertices"], short, atol=1e-5)


def test_it_sways_by_the_clock(stage: Stage) -> None:
    """To the full twist after a quarter of its time, and back; the picture depends on the frame alone."""
    stage.set(sway=True, twist=100)
    stage.seek(90)
    at_quarter = stage.measure()["min_radius_ratio"]
    assert at_quarter == pytest.approx(np.cos(np.radians(50.0)), abs=1e-3)
    stage.seek(180)
    assert stage.measure()["min_radius_ratio"] == pytest.approx(1.0, abs=1e-6)
    stage.seek(90)
    assert stage.measure()["min_radius_ratio"] == at_quarter


def test_a_large_model_looks_and_measures_as_a_small_one(make_stage: MakeStage,
                                                         monkeypatch: pytest.MonkeyPatch) -> None:
    """From some size on vertices are posed in a pass of their own, not whenever they are drawn."""
    def seen() -> tuple[np.ndarray, dict[str, np.ndarray], float]:
        stage = make_stage("", name="twisting_limb", size=(320, 180), params={"twist": 120, "bend": 30})
        stage.set(twist_bones=2)
        return stage.pixels(), stage.geometry(), float(stage.measure()["volume_ratio"])

    small = seen()
    monkeypatch.setattr("viewer.engine.limb_skin.LARGE", 1000)
    large = seen()
    assert (np.abs(large[0].astype(int) - small[0]).max(axis=2) > 1).mean() < 0.001
    for name in ("vertices", "normals"):
        assert np.abs(large[1][name] - small[1][name]).max() < 1e-5
    assert large[2] == pytest.approx(small[2], abs=1e-5)


@pytest.mark.parametrize("falloff", ["linear", "smooth", "narrow"])
def test_the_falloff_is_what_is_drawn_and_measured(stage: Stage, falloff: str) -> None:
    """Its weights are exported, with no extra bones too, and the limb follows the law for them."""
    stage.set(falloff=falloff, twist=150)
    found, curve = stage.geometry()["weights"], stage.measure()["radius_along_limb"]
    assert np.allclose(curve.series["measured"], curve.series["law"], atol=1e-4)
    share = stage.scene.limb.share
    assert np.allclose(found[:, 2], share * stage.scene.limb.held, atol=1e-6)
    blended = ((found[:, 2] > 0.01) & (found[:, 2] < 0.99)).sum()
    stage.set(falloff="linear")
    others = stage.geometry()["weights"][:, 2]
    evenly = ((others > 0.01) & (others < 0.99)).sum()
    assert blended < 0.5 * evenly if falloff == "narrow" else blended <= evenly


def test_what_sways_is_not_to_be_held(stage: Stage) -> None:
    """The rings would stand at a twist that passes, and write it down."""
    stage.set(show_bones=True)
    assert stage.handle()
    stage.set(sway=True)
    assert stage.handle() is None


@with_models
def test_words_for_one_model_do_not_keep_another_out(stage: Stage) -> None:
    """A joint that was clicked, a pose, weights: what the new model does not know is passed over, and told."""
    stage.set(bone="hand", pose="hand: 10 0 0", weights="forearm")
    stage.set(model=str(MODELS / "Fox.glb"))
    stage.render()
    told = [remark for remark in stage.remarks() if remark.startswith("Not used: ")]
    assert len(told) == 3 and any("bone = hand is none of the model's bones _rootJoint" in remark for remark in told)
    with pytest.raises(DemoscopeError, match="bone = foot is none"):
        stage.set(bone="foot")
    stage.set(bone="b_Tail02_013", pose="", weights="on")
    assert not [remark for remark in stage.remarks() if remark.startswith("Not used: ")]
    stage.set(model=None)
    assert any("bone = b_Tail02_013" in remark for remark in stage.remarks())


@with_models
def test_rings_that_are_too_far_apart_are_told(make_stage: MakeStage) -> None:
    """At its vertices the skin keeps its radius, on the edges between them it does not."""
    stage = make_stage("", name="twisting_limb", params={
        "model": str(MODELS / "RiggedSimple.glb"), "twist": 180, "method": "dual_quaternion"})
    read = stage.measure()
    assert read["min_radius_ratio"] == pytest.approx(1.0, abs=1e-3) and read["thinnest"] < 0.5
    assert any("too far apart" in remark for remark in stage.remarks())
    stage.set(model=None)                           # our arm has rings enough
    assert stage.measure()["thinnest"] == pytest.approx(1.0, abs=0.002) and not stage.remarks()
