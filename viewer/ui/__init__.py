"""The window and its panels: the only place that knows ImGui and the window system."""
