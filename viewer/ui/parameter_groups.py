"""Parameters under their headings, and which headings are folded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from imgui_bundle import imgui

from viewer.engine.fields import Field
from viewer.engine.formula_field import FormulaField
from viewer.engine.number_fields import FormulaSlider
from viewer.engine.params import Parameters
from viewer.ui import theme
from viewer.ui.theme import Fonts

HEADING_FLAGS = (imgui.TreeNodeFlags_.framed | imgui.TreeNodeFlags_.no_tree_push_on_open
                 | imgui.TreeNodeFlags_.span_avail_width)
HEADING_COLORS = [(int(role), imgui.ImVec4(*color)) for role, color in (
    (imgui.Col_.header, theme.HEADING), (imgui.Col_.header_hovered, theme.WELL_HOVERED),
    (imgui.Col_.header_active, theme.WELL_ACTIVE))]


@dataclass(frozen=True)
class Group:
    """Parameters that stand together; those without a heading have an empty title."""

    title: str
    fields: tuple[Field[Any], ...]
    idle: bool      # none of them has any effect now


def grouped(params: Parameters) -> list[Group]:
    """Every parameter: those without a heading first, then each heading where its first member was declared."""
    ordered = in_order(params)
    titles = sorted(dict.fromkeys(field.group for field in ordered), key=bool)
    members = {title: tuple(field for field in ordered if field.group == title) for title in titles}
    return [Group(title, fields, not any(params.is_active(field.name) for field in fields))
            for title, fields in members.items()]


def in_order(params: Parameters) -> list[Field[Any]]:
    """Declared order, with the sliders that a formula gave rise to right under it."""
    ordered: list[Field[Any]] = []
    fields = list(params.fields.values())
    for field in fields:
        if isinstance(field, FormulaSlider):
            continue
        ordered.append(field)
        if isinstance(field, FormulaField):
            variables = set(params.get(field.name).variables)
            ordered += [each for each in fields if isinstance(each, FormulaSlider) and each.name in variables
                        and each not in ordered]
    return ordered


class Folds:
    """Which groups of which scene were opened or folded by hand, for as long as the window is open.

    A group in which nothing has any effect is folded by itself, the others are open.
    """

    def __init__(self) -> None:
        self._by_hand: dict[tuple[str, str], bool] = {}

    def heading(self, scene: str, title: str, fonts: Fonts, *, idle: bool) -> bool:
        """Draw the heading of a group; returns whether the group is open."""
        key = scene, title
        for role, color in HEADING_COLORS:
            imgui.push_style_color(role, color)
        imgui.push_style_color(imgui.Col_.text, theme.QUIET_TEXT if idle else theme.TEXT)
        imgui.push_style_var(imgui.StyleVar_.frame_padding, imgui.ImVec2(0.3 * imgui.get_font_size(), 1))
        imgui.push_font(fonts.bold, 0.0)
        imgui.set_next_item_open(self._by_hand.get(key, not idle))
        unfolded = imgui.tree_node_ex(title, HEADING_FLAGS)
        if imgui.is_item_toggled_open():
            self._by_hand[key] = unfolded
        imgui.pop_font()
        imgui.pop_style_var()
        imgui.pop_style_color(len(HEADING_COLORS) + 1)
        return unfolded
