"""Linear blend skinning: why a twisted limb collapses, and what helps."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from viewer import (
    CarriedWords,
    Click,
    ColorScale,
    Geometry,
    Gpu,
    Handle,
    Insets,
    Label,
    LimbCaptions,
    LimbModel,
    LimbSkin,
    Measurements,
    Orbit,
    Parameters,
    Scene,
    Studio,
    choice,
    file,
    integer,
    limb_comparison,
    limb_curves,
    slider,
    text,
    toggle,
)
from viewer.kit import limb_pose
from viewer.kit.arm import CHECKS_AROUND
from viewer.kit.bone_model import bone_model
from viewer.kit.bone_pose import bone_named, clip_named, read_pose, written_name, written_pose
from viewer.kit.gltf import SUFFIXES, Clip
from viewer.kit.limb import Limb, limb_at, most_blended_bone, with_falloff
from viewer.kit.limb_layout import GROUND, LimbLayout, Stand, View
from viewer.kit.limb_source import model_in

LETTERS_HIGH, SMALLEST_LETTERS = 36.0, 12.0     # a picture in standard letters, and these at least in pixels
COMPARED = ("linear", "linear", "dual_quaternion")
ALONE = len(COMPARED)                   # the column of the limb that stands alone
EXTRA_BONES = 3                         # in the comparison, where none are asked for
SWAY_SECONDS = 6.0
TEXTURE_CHECKS = 16.0                   # for each unit of a model's own texture coordinates
CHECKERED, OWN, WEIGHTS, PLAIN = range(4)       # what the skin shows, as limb.frag has it
OFF, ON = ("", "false", "off", "no", "none"), ("true", "on", "yes")
LIMB, BONES, LOOK = "Limb", "Bones", "Look"
WORDS = ("bone", "pose", "weights", "animation")        # what speaks of a model's own bones and animations
SPARSE = 0.1                            # by how much thinner between vertices than at them is worth a remark
NEAR_JOINT = 0.03                       # how near to a joint a click is meant for it, in radians


class TwistingLimb(Scene):
    """A twisted limb collapses under linear blend skinning: the cause, two cures, and their measure."""

    class Params(Parameters):
        model: Path | None = file(None, "A rigged model of your own, glTF or GLB; without one, an arm of ours",
                                  suffixes=SUFFIXES)
        view: str = choice("compare", {
            "compare": "Linear blending, extra bones and dual quaternions side by side", "single": "One limb"},
            "What stands in the studio")
        method: str = choice("linear", {
            "linear": "Average the places to which the bones take a vertex",
            "dual_quaternion": "Average the bones' motions, so that the average is rigid too"},
            "How bones are blended, in the single view and in what is measured and exported")
        twist: float = slider(160.0, -360.0, 360.0, "How far the limb's far end is twisted", unit="degrees", group=LIMB)
        bend: float = slider(0.0, -150.0, 150.0, "How far the joint before it is bent", unit="degrees", group=LIMB)
        twist_bones: int = integer(0, 0, 8, "Extra bones that share the twist; where this is 0, 3 in the comparison",
                                   group=LIMB)
        falloff: str = choice("linear", {
            "linear": "Evenly, from joint to joint", "smooth": "Slowly at first and at last",
            "narrow": "Within the middle third"}, "How weights blend along the limb", rebuild=True, group=LIMB)
        sway: bool = toggle(False, "Twist to and fro as time goes on", group=LIMB)
        bone: str = text("", "The bone that is twisted, by name or number; or click on its joint",
                         longest=120, rebuild=True, group=BONES)
        pose: str = text("", "Bones turned about their own axes in degrees, as hand: 0 0 35; the rings in the picture "
                         "write this", longest=8000, group=BONES)
        show_bones: bool = toggle(False, "The bones, seen through the skin", group=BONES)
        weights: str = text("", "The bone whose weights are shown as colours, by name or number; on: the twisted one",
                            longest=120, group=BONES)
        animation: str = text("", "Which of the model's animations plays, by name or number; none for its pose at rest",
                              longest=120, group=BONES)
        animation_speed: float = slider(1.0, 0.0, 4.0, "How fast it plays", unit="x", handy=(0.0, 2.0), group=BONES)
        skin: str = choice("own", {
            "own": "The model's own colours; the arm's are checks", "checkered": "Checks, to see the twist by",
            "plain": "One colour"}, "What the skin looks like", group=LOOK)
        show_slice: bool = toggle(True, "The cross section, before in grey and after in colour", group=LOOK)
        slice: float = slider(0.5, 0.0, 1.0, "Where the limb is cut: 0 at the joint before it, 1 at its own",
                              group=LOOK, when="show_slice")

    camera = Orbit(yaw=14, pitch=9, distance=6.6, field_of_view=24)
    studio = Studio(radius=1.75, ground=GROUND)

    def __init__(self, gpu: Gpu, params: Params) -> None:
        self.gpu, self.params = gpu, params
        self.model = model_in(params.model)
        self.mesh = self.model.mesh
        self.names = [self.mesh.skeleton.names[joint] for joint in self.mesh.bones]
        self.words = CarriedWords(params, WORDS, params.model)
        name = self.word("bone")
        self.bone = self.words.meant("bone", lambda: bone_named(name, self.names) if name else -1, -1)
        if self.bone < 0:       # the one that is twisted
            self.bone = most_blended_bone(self.mesh)
        self.limb = self.chosen_limb()
        self.shared = LimbModel(gpu, self.model, self.limb)
        self.skins: dict[tuple[int, str], LimbSkin] = {}
        self.captions, self.bones = LimbCaptions(gpu), Insets(gpu)
        self.followed: Hashable = None
        self.words.settle()

    def word(self, name: str) -> str:
        """What was typed for a parameter, without blanks around it."""
        return str(self.params.get(name)).strip()

    def chosen_limb(self) -> Limb | None:
        """The limb that ends in that bone, its weights bent as the falloff asks; None where no bone is before it."""
        limb = limb_at(self.mesh, self.bone)
        return with_falloff(limb, self.params.falloff) if limb else None

    def skin(self, column: int, method: str) -> LimbSkin:
        """A limb of the comparison, by its column, or the one that stands alone and is measured: built when wanted."""
        if (column, method) not in self.skins:
            self.skins[column, method] = LimbSkin(self.shared, method)
        return self.skins[column, method]

    # The pose

    def prepare(self) -> None:
        wanted = self.params.revision, self.aspect, self.letters(), self.seconds(), self.gpu.generation
        if wanted != self.followed:
            self.followed = None
            local = self.local()
            for skin, twist_bones in self.shown():
                skin.pose(local, self.twist(), twist_bones)
            place = self.params.slice if self.params.show_slice else None
            self.captions.show([skin for skin, _ in self.shown()], self.aspect,
                               self.seen().apart / self.seen().half_height, place, self.letters())
            self.tell_shaders()
            self.followed = wanted

    def shown(self) -> list[tuple[LimbSkin, int]]:
        """The limbs in the picture, from left to right, and how many extra bones each has."""
        extra = self.params.twist_bones
        if self.params.view == "single" or not self.limb:
            return [(self.skin(ALONE, self.params.method), extra)]
        skins = [self.skin(column, method) for column, method in enumerate(COMPARED)]
        return list(zip(skins, (0, extra or EXTRA_BONES, 0), strict=True))

    def seconds(self) -> float:
        """The time, where anything moves by it."""
        return self.time if self.params.sway or self.clip() else 0.0

    def twist(self) -> float:
        """By how many degrees the limb is twisted now."""
        swung = math.sin(2.0 * math.pi * self.seconds() / SWAY_SECONDS) if self.params.sway else 1.0
        return float(self.params.twist * swung)

    def clip(self) -> Clip | None:
        """The animation that plays."""
        name, clips = self.word("animation"), self.model.clips
        if name.lower() in OFF[1:] or not (clips or name):
            return None
        number = self.words.meant("animation", lambda: clip_named(name, clips) if name else 0, 0)
        return clips[number] if clips else None

    def moment(self) -> NDArray[np.float64]:
        """Each joint in its parent's frame, (j, 4, 4), as the animation has it now, or at rest."""
        clip, skeleton = self.clip(), self.mesh.skeleton
        if clip is None:
            return skeleton.local()
        played = self.seconds() * self.params.animation_speed
        return skeleton.local(*clip.pose(skeleton, played % clip.seconds if clip.seconds > 0.0 else 0.0))

    def local(self) -> NDArray[np.float64]:
        """The same after what hands have turned, and bent; only the twist is still to come."""
        pose = limb_pose.posed(self.mesh, self.moment(), self.turned())
        return limb_pose.bent(self.limb, pose, self.params.bend) if self.limb else pose

    def turned(self) -> dict[int, NDArray[np.float64]]:
        """Which bones hands have turned, and how: rotation vectors in degrees."""
        return self.words.meant("pose", lambda: read_pose(self.params.pose, self.names), {})

    # In the studio

    def tell_shaders(self) -> None:
        """Say where the model stands, how large, and what its skin shows."""
        p, weighed, layout = self.params, self.weighed_bone(), self.layout()
        checkered = p.skin == "checkered" or (p.skin == "own" and p.model is None)
        self.shared.tell("u_model_middle", layout.origin)
        self.shared.tell("u_model_scale", layout.scale)
        self.shared.tell("u_weighed_bone", weighed)
        shown = CHECKERED if checkered else PLAIN if p.skin == "plain" else OWN
        self.shared.tell("u_skin_shown", WEIGHTS if weighed >= 0 else shown)
        self.shared.tell("u_pale", p.show_bones and weighed < 0)
        self.shared.tell("u_checks", TEXTURE_CHECKS if p.model else 1.0)
        self.shared.tell("u_stripe_every", CHECKS_AROUND)

    def seen(self) -> View:
        """How the camera starts, in this picture."""
        return View(self.camera.yaw, self.camera.distance, self.camera.field_of_view, self.aspect)

    def layout(self) -> LimbLayout:
        """How the limbs that are shown are laid out."""
        return LimbLayout(self.seen(), len(self.shown()), *self.shared.extent, self.captions.top)

    def stands(self) -> list[Stand]:
        """Where each limb stands, for the camera as it is now."""
        return self.layout().stands(self.eye, self.view[:3, 0])

    def turns_with_camera(self) -> bool:
        return len(self.shown()) > 1

    def middle(self) -> tuple[float, float]:
        return (0.0, self.layout().raised) if self.limb else (0.0, 0.0)

    def letters(self) -> float:
        """The height of standard letters, in half heights of the picture."""
        return 2.0 * max(SMALLEST_LETTERS / self.gpu.context.fbo.height, 1.0 / LETTERS_HIGH)

    def draw(self) -> None:
        for (skin, _), stand in zip(self.shown(), self.stands(), strict=True):
            skin.draw(stand)

    def draw_over(self) -> None:
        if self.params.show_bones:
            for (skin, extra), stand in zip(self.shown(), self.stands(), strict=True):
                places = stand.placed(self.layout().in_studio(skin.joint_places()))
                self.bones.show(bone_model(self.mesh, places, self.bone, self.limb, extra))
                self.bones.draw(through=True)
        self.captions.draw()

    def labels(self) -> Sequence[Label]:
        return self.captions.labels()

    # Bones: their weights, clicks on them, the rings

    def weighed_bone(self) -> int:
        """The bone whose weights are shown; -1 where none are."""
        name = self.word("weights")
        if name.lower() in (*OFF, *ON):
            return self.bone if name.lower() in ON else -1
        return self.words.meant("weights", lambda: bone_named(name, self.names, "weights"), -1)

    def color_scale(self) -> ColorScale | None:
        weighed = self.weighed_bone()
        return ColorScale(f"weight of {self.names[weighed]}", 0.0, 1.0) if weighed >= 0 else None

    def click(self, click: Click) -> Mapping[str, object]:
        nearest, chosen = NEAR_JOINT, ""
        for (skin, _), stand in zip(self.shown(), self.stands(), strict=True):
            away = stand.placed(self.layout().in_studio(skin.joint_places())) - click.origin
            depth = away @ click.direction
            beside = np.linalg.norm(np.cross(away, click.direction), axis=1) / np.maximum(depth, 1e-9)
            beside[depth <= 0.0] = np.inf       # behind the eye
            if beside.min() < nearest:
                nearest, chosen = float(beside.min()), written_name(int(beside.argmin()), self.names)
        return {"bone": chosen, "show_bones": True} if chosen else {}

    def handle(self) -> Handle | None:
        if not self.params.show_bones or self.params.sway:     # what sways is not to be held
            return None
        bone, (skin, _) = self.bone, self.shown()[len(self.shown()) // 2]
        matrix = limb_pose.upright(skin.matrices[bone] @ self.mesh.bound_frames[bone])
        matrix[:3, 3] = self.layout().in_studio(matrix[None, :3, 3])[0]
        return Handle(matrix, f"turn {self.names[bone]}")

    def drag_handle(self, handle: Handle) -> Mapping[str, object]:
        p, bone = self.params, self.bone
        turned, twist = limb_pose.turned_by_hand(self.mesh, self.limb, bone, self.moment(), self.local(),
                                                 handle.matrix[:3, :3], p.bend, p.twist)
        pose = self.turned() | {bone: turned}
        return {"pose": written_pose(pose, self.names), "twist": min(360.0, max(-360.0, twist))}

    # What it tells

    def measured(self) -> LimbSkin:
        """The limb that is measured and exported: skinned by the chosen method, with the chosen extra bones."""
        skin = self.skin(ALONE, self.params.method)
        skin.pose(self.local(), self.twist(), self.params.twist_bones)
        return skin

    def geometry(self) -> Geometry:
        skin = self.measured()
        places, normals = skin.posed()
        return {"vertices": places, "triangles": self.mesh.triangles, "normals": normals,
                "rest_vertices": self.mesh.positions, "rest_normals": self.mesh.normals, "joints": skin.joints,
                "weights": skin.weights, "matrices": skin.matrices}

    def measure(self) -> Measurements:
        skin = self.measured()
        numbers = {"bones": len(skin.matrices), "influences": int((skin.weights > 0.0).sum(axis=1).max()),
                   "unnormalised_vertices": self.model.unnormalised_vertices,
                   "vertices": len(self.mesh.positions), "triangles": len(self.mesh.triangles)}
        found = skin.numbers()
        if self.limb is None or found is None or not len(self.limb.measured):
            return numbers
        ratios = {"min_radius_ratio": found.min_radius_ratio, "thinnest": found.thinnest,
                  "volume_ratio": found.volume_ratio, "area_ratio": found.area_ratio}
        curves = limb_curves(skin, self.local(), self.twist(), self.params.slice)
        return {**ratios, **numbers, **curves, "comparison": limb_comparison([skin for skin, _ in self.shown()])}

    def remarks(self) -> Sequence[str]:
        found, model = [*self.model.notes, *self.words.remarks()], self.model
        if any(each.thinnest < each.min_radius_ratio - SPARSE for each in self.captions.numbers):
            found.append("Between its rings of vertices this skin is thinner than at them: they are too far apart.")
        if model.unnormalised_vertices:
            found.append(f"The weights of {model.unnormalised_vertices} vertices did not sum to 1; now they do.")
        if not self.limb:
            found.append(f"{self.names[self.bone]} has no bone before it: there is no limb to twist.")
        elif abs(self.twist()) > 180.0 and self.shown()[-1][0].method == "dual_quaternion":
            found.append("Past half a turn dual quaternions take the short way round: they know where a bone is, "
                         "not how it came there.")
        return found
