"""The only module that calls OpenGL: contexts, programs by text, targets, uniforms, and functions evaluated over tables."""

import ctypes
import ctypes.util
import sys
from contextlib import contextmanager
from copy import copy

import moderngl
import numpy as np

from .glsl import Signature, assemble, of_model
from .lib.random import ROW, next_pass
from .model import Invalid, Param, declared

PACKAGES = (
    "on Debian or Ubuntu: apt install libegl1 libgl1-mesa-dri; on Fedora: dnf install mesa-libEGL mesa-dri-drivers; "
    "on Arch: pacman -S mesa libglvnd"
)
BLENDING = {
    "over": (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ONE, moderngl.ONE),
    "premultiplied": (moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA),
    "add": (moderngl.ONE, moderngl.ONE),
    # the source's alpha is its share of a running mean; the target's stays
    "mean": (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ZERO, moderngl.ONE),
}
_open = []  # the Gpu of `offscreen`, while there is one


@contextmanager
def offscreen():
    """A Gpu without a window: EGL, else OSMesa, else Invalid that names the packages to install.

    Within another `offscreen` it is the same Gpu: two contexts in one thread would take each other's place.
    """
    if _open:
        yield _open[0]
        return
    gpu = Gpu(_standalone())
    _open.append(gpu)
    try:
        yield gpu
    finally:
        _open.clear()
        gpu.ctx.release()


def window():
    """A Gpu on the OpenGL context of the window that is current."""
    return Gpu(moderngl.create_context(require=330))


def _standalone():
    attempts = []
    backends = [("EGL", {"backend": "egl"})] if sys.platform.startswith("linux") else [("OpenGL", {})]
    for name, options in backends:
        try:
            return moderngl.create_context(standalone=True, require=330, **options)
        except Exception as error:  # glcontext raises bare Exception for each cause
            attempts.append(f"{name}: {str(error).strip()}")
    if sys.platform.startswith("linux"):
        try:
            return moderngl.create_context(context=OSMesa(), require=330)
        except OSError as error:
            attempts.append(f"OSMesa: {error}")
    hint = f"; {PACKAGES}" if sys.platform.startswith("linux") else ""
    raise Invalid(f"no OpenGL 3.3 without a window ({'; '.join(attempts)}){hint}")


class OSMesa:
    """A software context from Mesa's libOSMesa, in the form that moderngl.create_context(context=...) takes.

    Raises OSError when the library or a core 3.3 context is missing.
    """

    # OSMESA_FORMAT RGBA, PROFILE CORE, CONTEXT_MAJOR_VERSION 3, MINOR 3, DEPTH_BITS 24, end
    ATTRIBUTES = (0x22, 0x1908, 0x33, 0x34, 0x36, 3, 0x37, 3, 0x30, 24, 0)

    def __init__(self):
        self.library = ctypes.CDLL(ctypes.util.find_library("OSMesa") or "libOSMesa.so.8")
        self.library.OSMesaCreateContextAttribs.restype = ctypes.c_void_p
        self.library.OSMesaGetProcAddress.restype = ctypes.c_void_p
        attributes = (ctypes.c_int * len(self.ATTRIBUTES))(*self.ATTRIBUTES)
        self.handle = ctypes.c_void_p(self.library.OSMesaCreateContextAttribs(attributes, None))
        self.buffer = (ctypes.c_ubyte * 256)()
        unsigned_byte = 0x1401
        if not self.handle or not self.library.OSMesaMakeCurrent(self.handle, self.buffer, unsigned_byte, 8, 8):
            raise OSError("libOSMesa makes no OpenGL 3.3 core context")

    def load_opengl_function(self, name):
        return self.library.OSMesaGetProcAddress(name.encode()) or 0

    def __enter__(self):
        return self

    def __exit__(self, *error):
        pass

    def release(self):
        if self.handle:
            self.library.OSMesaDestroyContext(self.handle)
            self.handle = None


class Gpu:
    """A moderngl context with its programs and targets. Views draw with it; a window or `offscreen` makes it."""

    def __init__(self, ctx):
        self.ctx = ctx
        ctx.gc_mode = "context_gc"  # what Python drops is released by the next draw, in the thread of the context
        self.programs = {}
        self.targets = {}
        self.buffers = {}
        self.arrays = {}
        self.sides = {}
        self.pace = (
            None  # seconds that a step of a picture may take where a view divides them; None: a step is a whole drawing
        )
        self.speeds = {}  # program -> seconds a pixel, measured by views/pace.py
        self.drawn = set()  # (program, size, format) of draws, for measure/cost.py, which empties it before some work
        self.costs = {}  # measured there
        self.errors = {}  # of measure/tradeoff.py
        self.evidence = {}  # of measure/judge.py

    def beside(self, name):
        """Another Gpu of this context, kept under a name: its targets are its own, programs and buffers are shared."""
        if name not in self.sides:
            self.sides[name] = side = Gpu(self.ctx)
            side.programs, side.buffers, side.arrays = self.programs, self.buffers, self.arrays
            side.speeds = self.speeds
        return self.sides[name]

    def paced(self, seconds):
        """This Gpu, with steps of `seconds` at most where a view divides a drawing into steps."""
        other = copy(self)
        other.pace = seconds
        return other

    @property
    def device(self):
        """Renderer and GL version, as the driver names them."""
        return f"{self.ctx.info['GL_RENDERER']}, OpenGL {self.ctx.info['GL_VERSION']}"

    def apart(self):
        """This Gpu with targets of its own: what is drawn with it meets no other picture of the same name."""
        other = copy(self)
        other.targets, other.pace = {}, None
        return other

    def program(self, fragment, vertex=None):
        """The linked program of two Sources, from the cache if their text was seen. Raises Invalid with file and line."""
        vertex = vertex or assemble("views/full.vert")
        key = (vertex.text, fragment.text)
        if key not in self.programs:
            try:
                self.programs[key] = self.ctx.program(vertex_shader=vertex.text, fragment_shader=fragment.text)
            except moderngl.Error as error:
                stage = vertex if "vertex_shader" in str(error) else fragment
                raise Invalid(stage.explain(_log(str(error)))) from None
        return self.programs[key]

    def target(self, name, size, components=4, dtype="f4", depth=False):
        """The framebuffer of that name with one texture, and depth if asked; kept while size and format stay, clear at first."""

        def make():
            buffers = [self.ctx.depth_renderbuffer(size)] if depth else []
            return [self.ctx.texture(size, components, dtype=dtype), *buffers]

        return self._kept(name, (tuple(size), components, dtype, depth), make)

    def _kept(self, name, form, make):
        if name in self.targets:
            framebuffer, old = self.targets[name]
            if old == form:
                return framebuffer
        attachments = make()
        framebuffer = self.ctx.framebuffer(attachments[:1], *attachments[1:])
        framebuffer.clear()
        self.targets[name] = (framebuffer, form)
        return framebuffer

    def texture(self, array):
        """A float32 texture of an array (H, W) or (H, W, C), its first row the first of texelFetch, not filtered."""
        array = np.ascontiguousarray(array, dtype=np.float32)
        components = array.shape[2] if array.ndim == 3 else 1
        texture = self.ctx.texture((array.shape[1], array.shape[0]), components, array.tobytes(), dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def draw(
        self,
        program,
        target,
        uniforms=None,
        textures=None,
        *,
        vertices=3,
        index=None,
        instances=1,
        blend=None,
        depth=False,
        box=None,
    ):
        """Draw attribute-less triangles (by default the one that fills the target) or those of an index buffer.

        uniforms: name -> number, tuple, or a Declared instance for a struct; a name the compiler dropped is skipped.
        textures: name -> texture. blend: a key of BLENDING. depth: hide what lies behind. box: left, bottom, right, top in
        pixels, outside of which nothing is drawn.
        """
        for name, value in (uniforms or {}).items():
            set_uniform(program, name, value)
        for unit, (name, texture) in enumerate((textures or {}).items()):
            if name in program:
                texture.use(unit)
                program[name] = unit
        key = (program, index)
        if key not in self.arrays:
            self.arrays[key] = self.ctx.vertex_array(program, [], index_buffer=index)
        self.drawn.add((program, target.size, target.color_attachments[0].dtype))
        ctx = self.ctx
        self.collect()
        ctx.enable_only((moderngl.BLEND if blend else 0) | (moderngl.DEPTH_TEST if depth else 0))
        if blend:
            ctx.blend_func = BLENDING[blend]
        if box is not None:
            left, bottom, right, top = np.clip(np.round(box), 0, [*target.size, *target.size]).astype(int).tolist()
            target.scissor = left, bottom, max(right - left, 0), max(top - bottom, 0)
        target.use()
        self.arrays[key].render(moderngl.TRIANGLES, vertices=-1 if index else vertices, instances=instances)
        if box is not None:
            target.scissor = None

    def collect(self):
        """Release what Python dropped; ctx.gc() would raise for what had been released by hand before."""
        while self.ctx.objects:
            dropped = self.ctx.objects.popleft()
            if hasattr(dropped, "release"):
                dropped.release()

    def pixels(self, target):
        """The target's colours as an array (H, W, C), first row at the top."""
        texture = target.color_attachments[0]
        dtype = {"f1": np.uint8, "f2": np.float16, "f4": np.float32}[texture.dtype]
        data = np.frombuffer(target.read(components=texture.components, dtype=texture.dtype, alignment=1), dtype)
        return np.ascontiguousarray(data.reshape(texture.height, texture.width, texture.components)[::-1])

    # --- functions over tables -----------------------------------------------------------------------------------------

    def f(self, model, wo, wi):
        """float32 f from the GLSL, (..., 3); arguments as Model.f."""
        return self.evaluate_model(model, "vec3 f(vec3 wo, vec3 wi)", wo, wi)[0]

    def pdf(self, model, wo, wi):
        """float32 pdf from the GLSL, (...); arguments as Model.pdf."""
        return self.evaluate_model(model, "float pdf(vec3 wo, vec3 wi)", wo, wi)[0]

    def sample_f(self, model, wo, u):
        """float32 (wi, weight) from the GLSL, (..., 3) each; arguments as Model.sample_f."""
        weight, wi = self.evaluate_model(model, "vec3 sample_f(vec3 wo, vec2 u, out vec3 wi)", wo, u)
        return wi, weight

    def evaluate_model(self, model, signature, *arguments):
        """Values of a function of a model, as `evaluate`; a stochastic one draws the next pass, as its twin does."""
        include = [f"models/{model.name()}.glsl", "views/seeding_{seeding}.glsl"]

        def source(call):
            chunk = "".join(f'#include "{path}"\n' for path in include)
            return of_model("views/probe.frag", model, generated={"chunk.glsl": chunk, "call.glsl": call})

        uniforms = {"material": model}
        first = ""
        if model.stochastic:
            uniforms["pass"] = next_pass()
            first = "seed_random(pass);"
        return self.evaluate(source, signature, *arguments, uniforms=uniforms, first=first)

    def evaluate_chunk(self, path, signature, *arguments, slots=None):
        """Values of a function of a file in shaders/, such as ("lib/fresnel.glsl", "float F0(float eta, float k)", eta, k)."""

        def source(call):
            return assemble("views/probe.frag", slots, {"chunk.glsl": f'#include "{path}"\n', "call.glsl": call})

        return self.evaluate(source, signature, *arguments)

    def evaluate(self, source, signature, *arguments, uniforms=None, first=""):
        """Values of a GLSL function over tables of arguments, in float32.

        source(call) gives the Source of views/probe.frag around the generated `call`. Arguments broadcast like (..., n), a
        float being n = 1 without the axis. first: statements before the call. Returns a list of the value and then each `out`
        argument.
        """
        function = Signature(signature)
        with np.errstate(under="ignore"):  # what float32 cannot hold is 0
            columns = [
                np.asarray(a, dtype=t.dtype)[..., None] if t.components == 1 else np.asarray(a, dtype=t.dtype)
                for a, t in zip(arguments, function.inputs, strict=True)
            ]
        shape = np.broadcast_shapes(*(c.shape[:-1] for c in columns))
        count = int(np.prod(shape, dtype=int))
        width = min(ROW, max(count, 1))
        height = max(-(-count // width), 1)
        program = self.program(source(function.call(first)))
        textures = {}
        for i, (column, kind) in enumerate(zip(columns, function.inputs, strict=True)):
            table = np.zeros((height * width, 4), dtype=kind.dtype)
            table[:count, : kind.components] = np.broadcast_to(column, (*shape, kind.components)).reshape(count, -1)
            textures[f"argument{i}"] = self.ctx.texture((width, height), 4, table.tobytes(), dtype=kind.dtype)
        outputs = [self.ctx.texture((width, height), 4, dtype="f4") for _ in function.outputs]
        target = self.ctx.framebuffer(outputs)
        self.draw(program, target, uniforms, textures)
        results = []
        for i, kind in enumerate(function.outputs):
            data = np.frombuffer(target.read(components=4, attachment=i, dtype="f4"), np.float32).reshape(-1, 4)
            data = data[:count, : kind.components].reshape(*shape, kind.components)
            results.append(data[..., 0] if kind.components == 1 else data)
        return results


def set_uniform(program, name, value):
    """Set a uniform, or each param of a Declared instance as a member of the struct `name`."""
    if hasattr(value, "__dataclass_fields__"):
        for member in declared(value, Param):
            set_uniform(program, f"{name}.{member}", getattr(value, member))
    elif name in program:
        program[name] = value


def _log(message):
    """The compiler's own lines of moderngl's message."""
    return "\n".join(line for line in message.splitlines() if ":" in line or "(" in line) or message
