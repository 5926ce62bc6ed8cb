"""The window: the only imgui and glfw. Imported inside the command that opens it, so all else starts without it."""


def run(state, path=None):
    """Open the window on a State and return when it is closed. path: the preset's file, where Save writes.

    Raises Invalid where there is no screen or no OpenGL 3.3.
    """
    from .window import Window

    Window(state, path).run()
