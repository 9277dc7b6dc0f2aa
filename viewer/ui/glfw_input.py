"""GLFW's events as ImGui's. Letters are taken as the keyboard's layout has them: Ctrl+Z is where Z is."""

from __future__ import annotations

from typing import Any

from imgui_bundle import imgui  # before glfw, for which it sets the library's path

import glfw  # isort: skip

from viewer.ui.imgui_session import ImguiSession

Key = imgui.Key

NAMED = {
    "SPACE": Key.space, "APOSTROPHE": Key.apostrophe, "COMMA": Key.comma, "MINUS": Key.minus, "PERIOD": Key.period,
    "SLASH": Key.slash, "SEMICOLON": Key.semicolon, "EQUAL": Key.equal, "LEFT_BRACKET": Key.left_bracket,
    "BACKSLASH": Key.backslash, "RIGHT_BRACKET": Key.right_bracket, "GRAVE_ACCENT": Key.grave_accent,
    "ESCAPE": Key.escape, "ENTER": Key.enter, "TAB": Key.tab, "BACKSPACE": Key.backspace, "INSERT": Key.insert,
    "DELETE": Key.delete, "RIGHT": Key.right_arrow, "LEFT": Key.left_arrow, "DOWN": Key.down_arrow,
    "UP": Key.up_arrow, "PAGE_UP": Key.page_up, "PAGE_DOWN": Key.page_down, "HOME": Key.home, "END": Key.end,
    "KP_ADD": Key.keypad_add, "KP_SUBTRACT": Key.keypad_subtract, "KP_MULTIPLY": Key.keypad_multiply,
    "KP_DIVIDE": Key.keypad_divide, "KP_DECIMAL": Key.keypad_decimal, "KP_ENTER": Key.keypad_enter,
    "LEFT_SHIFT": Key.left_shift, "LEFT_CONTROL": Key.left_ctrl, "LEFT_ALT": Key.left_alt,
    "LEFT_SUPER": Key.left_super, "RIGHT_SHIFT": Key.right_shift, "RIGHT_CONTROL": Key.right_ctrl,
    "RIGHT_ALT": Key.right_alt, "RIGHT_SUPER": Key.right_super, "MENU": Key.menu,
}
NUMBERED = (
    {f"{digit}": getattr(Key, f"_{digit}") for digit in range(10)}
    | {f"KP_{digit}": getattr(Key, f"keypad{digit}") for digit in range(10)}
    | {f"F{number}": getattr(Key, f"f{number}") for number in range(1, 13)}
    | {chr(code).upper(): getattr(Key, chr(code)) for code in range(ord("a"), ord("z") + 1)})
KEYS: dict[int, imgui.Key] = {getattr(glfw, f"KEY_{name}"): key for name, key in {**NAMED, **NUMBERED}.items()}
BY_LETTER: dict[str, imgui.Key] = {chr(code): getattr(Key, chr(code)) for code in range(ord("a"), ord("z") + 1)} | {
    ",": Key.comma, ".": Key.period, "-": Key.minus, "+": Key.equal, "=": Key.equal}
MODIFIERS = (
    (Key.mod_ctrl, (glfw.KEY_LEFT_CONTROL, glfw.KEY_RIGHT_CONTROL)),
    (Key.mod_shift, (glfw.KEY_LEFT_SHIFT, glfw.KEY_RIGHT_SHIFT)),
    (Key.mod_alt, (glfw.KEY_LEFT_ALT, glfw.KEY_RIGHT_ALT)),
    (Key.mod_super, (glfw.KEY_LEFT_SUPER, glfw.KEY_RIGHT_SUPER)),
)
CURSORS: dict[int, int] = {
    imgui.MouseCursor_.arrow: glfw.ARROW_CURSOR, imgui.MouseCursor_.text_input: glfw.IBEAM_CURSOR,
    imgui.MouseCursor_.resize_ns: glfw.VRESIZE_CURSOR, imgui.MouseCursor_.resize_ew: glfw.HRESIZE_CURSOR,
    imgui.MouseCursor_.hand: glfw.HAND_CURSOR,
}


class GlfwInput:
    """Feeds one GLFW window's events to one ImGui session, and lends it clipboard and cursors."""

    def __init__(self, handle: Any, session: ImguiSession) -> None:
        self.handle, self.session = handle, session
        self._cursors = {shape: glfw.create_standard_cursor(number) for shape, number in CURSORS.items()}
        self._cursor = -1
        session.io.backend_flags |= imgui.BackendFlags_.has_mouse_cursors
        platform = imgui.get_platform_io()
        platform.platform_get_clipboard_text_fn = lambda _: _clipboard(handle)
        platform.platform_set_clipboard_text_fn = lambda _, text: glfw.set_clipboard_string(handle, text)
        glfw.set_key_callback(handle, self._key)
        glfw.set_char_callback(handle, lambda _, code: session.io.add_input_character(code))
        glfw.set_cursor_pos_callback(handle, lambda _, x, y: session.io.add_mouse_pos_event(x, y))
        glfw.set_cursor_enter_callback(handle, self._enter)
        glfw.set_mouse_button_callback(handle, self._button)
        glfw.set_scroll_callback(handle, lambda _, x, y: session.io.add_mouse_wheel_event(x, y))
        glfw.set_window_focus_callback(handle, lambda _, focused: session.io.add_focus_event(bool(focused)))

    def show_cursor(self) -> None:
        """Give the mouse the shape that ImGui asks for."""
        self.session.make_current()
        wanted = imgui.get_mouse_cursor()
        if wanted != self._cursor:
            self._cursor = wanted
            glfw.set_cursor(self.handle, self._cursors.get(wanted, self._cursors[imgui.MouseCursor_.arrow]))

    def _key(self, handle: Any, key: int, scancode: int, action: int, modifiers: int) -> None:
        if action == glfw.REPEAT:    # ImGui repeats by itself
            return
        io = self.session.io
        self._add_modifiers()
        named = _translated(key, scancode)
        if named is not None:
            io.add_key_event(named, action == glfw.PRESS)

    def _add_modifiers(self) -> None:
        """From the keys themselves: what GLFW reports with an event lags by that event on X11."""
        io = self.session.io
        for modifier, keys in MODIFIERS:
            io.add_key_event(modifier, any(glfw.get_key(self.handle, key) == glfw.PRESS for key in keys))

    def _button(self, handle: Any, button: int, action: int, modifiers: int) -> None:
        self._add_modifiers()
        if 0 <= button < 5:
            self.session.io.add_mouse_button_event(button, action == glfw.PRESS)

    def _enter(self, handle: Any, entered: int) -> None:
        if not entered:
            self.session.io.add_mouse_pos_event(-1e30, -1e30)


def _translated(key: int, scancode: int) -> imgui.Key | None:
    if key in (glfw.KEY_UNKNOWN, None):
        return None
    if not glfw.KEY_KP_0 <= key <= glfw.KEY_KP_EQUAL:
        letter = glfw.get_key_name(key, scancode)
        if letter and letter.lower() in BY_LETTER:
            return BY_LETTER[letter.lower()]
    return KEYS.get(key)


def _clipboard(handle: Any) -> str:
    text: Any = glfw.get_clipboard_string(handle)    # declared as text, in fact bytes
    return text.decode("utf-8", "replace") if isinstance(text, bytes) else text or ""
