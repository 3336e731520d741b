#!/usr/bin/env bash
# The Python module: its structs and functions are the header's, public names have docstrings and type hints, README's lines
# run, errors are exceptions with the library's text, a callback's exception calls the work off, and the picture has the program's bits.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
# shellcheck source=tests/fixtures/python.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/python.sh"

find_python_with_numpy || skip "numpy for Python (python3-numpy) is not installed"
export AFTERGLOW_LIBRARY=$AFTERGLOW_BUILD_DIR/lib/libafterglow.so PYTHONPATH=$AFTERGLOW_BUILD_DIR/python PYTHONDONTWRITEBYTECODE=1
cd "$folder"

"$python" - >layout.c <<'END'
import ctypes
from afterglow import _declarations

print('#include "afterglow/afterglow.h"')
assert len(_declarations.STRUCTURES) > 20 and len(_declarations.ENUMERATIONS) > 15
for public, struct in _declarations.STRUCTURES.items():
    print(f'_Static_assert(sizeof({public}) == {ctypes.sizeof(struct)}, "size of {public}");')
    for field, *_ in struct._fields_:
        own = getattr(struct, field)
        print(f'_Static_assert(offsetof({public}, {field}) == {own.offset} && '
              f'sizeof((({public} *)0)->{field}) == {own.size}, "{public}.{field}");')
for public in _declarations.ENUMERATIONS:
    print(f'_Static_assert(sizeof({public}) == sizeof(int), "size of {public}");')
END
"$CC" -std=c17 -I "$root/renderer/include" -I "$root/threads/include" -fsyntax-only layout.c ||
    fail "the module's structs are not the header's"
echo "ok: layout"

# tests/fixtures/public_abi.txt is what the headers say (test_public_abi.sh).
"$python" - "$root/tests/fixtures/public_abi.txt" <<'END' || fail "the module's functions or enumerations are not the header's"
import ctypes, re, sys
from afterglow import _declarations, _interface

NAMED = {"void": None, "int": ctypes.c_int, "size_t": ctypes.c_size_t, "uint64_t": ctypes.c_uint64,
         "ag_handle": ctypes.c_uint64, "float": ctypes.c_float, "double": ctypes.c_double, "_Bool": ctypes.c_bool,
         "unsigned": ctypes.c_uint, "ag_sample_counts": _declarations.SampleCounts,
         "ag_commit_counts": _declarations.CommitCounts}

def kind(text):
    """Of a parameter or result in C: pointer, or the ctypes type."""
    if "*" in text or "[" in text:
        return "pointer"
    name = text.replace("const ", "").split()[0]
    return NAMED[name] if name in NAMED or not name.startswith("ag_") else ctypes.c_int  # an enum

def own_kind(type):
    is_pointer = type in (ctypes.c_void_p, ctypes.c_char_p) or (type and issubclass(type, ctypes._Pointer))
    return "pointer" if is_pointer else type

def differ(own, text):
    result, arguments = re.fullmatch(r"(.*?)ag_\w+\((.*)\)", text).groups()
    wanted = [] if arguments == "void" else [kind(each.strip()) for each in arguments.split(",")]
    return [own_kind(each) for each in own.argtypes] != wanted or own_kind(own.restype) != kind(result)

record, members, enums = {}, {}, {}
for line in open(sys.argv[1]).read().splitlines():
    if line.startswith("function "):
        text = line[len("function "):]
        record[re.search(r"(ag_\w+)\(", text).group(1)] = text
    elif line.startswith("struct "):
        members[line.split()[1]] = []
    elif " at " in line:
        struct, member = line.split()[0].split(".")
        members[struct].append(member)
    elif line.startswith("enum "):
        values = enums[line.split()[1]] = []
    elif " = " in line:
        values.append(line.split(" = "))
used = {name: own for name, own in vars(_interface.library).items() if name.startswith("ag_")}
wrong = [name for name, own in used.items() if name not in record or differ(own, record[name])]
assert used.keys() == record.keys() and not wrong, wrong
assert members == {name: [field for field, *_ in own._fields_] for name, own in _declarations.STRUCTURES.items()}
assert enums.keys() == _declarations.ENUMERATIONS.keys()
for name, values in enums.items():
    own = list(_declarations.ENUMERATIONS[name])
    assert [int(value) for _, value in values] == own, name
    assert all(member.strip().endswith("_" + each.name) for (member, _), each in zip(values, own)), name
some = _interface.library.ag_rendering_continue
assert differ(some, "ag_status ag_rendering_continue(ag_rendering *rendering, size_t samples)")
assert differ(some, "ag_status ag_rendering_continue(ag_rendering *rendering)")
assert differ(some, "void ag_rendering_continue(ag_rendering *rendering, int samples)")
END
echo "ok: functions and enumerations"

# What the headers gain reaches the module without an edit; what is not understood is an error, and nothing is written.
"$CC" -std=c17 -E -P -x c -I "$root/renderer/include" -I "$root/threads/include" "$root/renderer/include/afterglow/afterglow.h" -o public.i
sed 's/^} ag_light;/    const ag_texture *gained, *more; float row[AG_GAINED];\n&/
    s/^typedef struct ag_light {/typedef enum ag_gained { AG_LOST = 2, AG_GAINED } ag_gained; &/' public.i >gained.i
cat >>gained.i <<'END'
__attribute__((visibility("default"))) const float *ag_gain(ag_scene *scene, const double up[3], ag_handle *out_handle,
                                                            ag_gained how, const char *const *names, const ag_light *light);
END
"$python" "$root/renderer/python/make_declarations.py" gained.i gained.py || fail "headers that gain are not understood"
"$python" - <<'END' || fail "what the headers gain does not reach the module"
import ctypes, gained
from ctypes import POINTER
from afterglow import _declarations

before, after = _declarations.Light._fields_, gained.Light._fields_
assert [name for name, _ in after[len(before):]] == ["gained", "more", "row"], after
assert [kind for _, kind in after[len(before):]] == [POINTER(gained.Texture)] * 2 + [ctypes.c_float * 3], after
assert ctypes.sizeof(gained.Light) == ctypes.sizeof(_declarations.Light) + 32
assert dict(gained.Gained.__members__) == {"LOST": 2, "GAINED": 3}
assert gained.FUNCTIONS.keys() - _declarations.FUNCTIONS.keys() == {"ag_gain"}
assert gained.FUNCTIONS["ag_gain"] == (POINTER(ctypes.c_float), [
    ctypes.c_void_p, ctypes.c_void_p, POINTER(ctypes.c_uint64), ctypes.c_int, POINTER(ctypes.c_char_p),
    POINTER(gained.Light)])
END
for strange in 's/^} ag_light;/    long double wide;\n&/' 's/^} ag_light;/    int bits : 3;\n&/' \
    's/^} ag_light;/    struct { int x; } inner;\n&/' 's/^} ag_light;/    void (*call)(int);\n&/' \
    's/^typedef struct ag_light {/typedef union ag_both { int a; float b; } ag_both;\n&/' \
    's/int ag_film_channel_count(/ag_nothing ag_film_channel_count(/'; do
    sed "$strange" public.i >strange.i
    ! cmp -s strange.i public.i || fail "nothing is changed by $strange"
    expect 1 "strange.i: not understood: " "$python" "$root/renderer/python/make_declarations.py" strange.i strange.py
    [[ ! -e strange.py ]] || fail "declarations are written in spite of $strange"
done
echo "ok: what headers gain"

"$python" - <<'END' || fail "public names lack a docstring or a type hint"
import inspect, sys, typing, afterglow

def lacks(name, item):
    """Names what a public class, function or method lacks."""
    if not (item.__doc__ or "").strip() and not name.endswith("__"):
        yield f"{name}: a docstring"
    if inspect.isclass(item):
        for member, value in vars(item).items():
            # contexts alone are made by their class, the others by methods
            is_public = not member.startswith("_") or member in ("__enter__", "__exit__")
            if inspect.isfunction(value) and (is_public or (name, member) == ("Context", "__init__")):
                yield from lacks(f"{name}.{member}", value)
    elif inspect.isfunction(item):
        hints = typing.get_type_hints(item)  # raises where one names nothing
        wanted = [parameter for parameter in inspect.signature(item).parameters if parameter != "self"] + ["return"]
        yield from (f"{name}: the type of {each}" for each in wanted if each not in hints)

class Bare:
    def method(self, a, b: int):
        pass

assert len(list(lacks("Bare", Bare))) == 4, list(lacks("Bare", Bare))
for name, item in vars(afterglow).items():
    if getattr(item, "__module__", None) == "afterglow" and not name.startswith("_"):
        assert name in afterglow.__all__, f"{name} is not in __all__"
found = [lack for name in afterglow.__all__ for lack in lacks(name, getattr(afterglow, name))]
for lack in found:
    print("lacking:", lack, file=sys.stderr)
sys.exit(1 if found else 0)
END
echo "ok: docstrings and type hints"

# A checker of types reads the hints of the module as it is installed, and finds what is wrong.
if command -v mypy >/dev/null; then
    mkdir -p typed/afterglow
    cp "$AFTERGLOW_BUILD_DIR"/python/afterglow/{*.py,py.typed} typed/afterglow
    cat >right.py <<'END'
import afterglow, numpy
from numpy.typing import NDArray

with afterglow.Context(threads=1, warn=print) as context, context.scene(editable=True) as scene:
    lamp: int = scene.light("point", {"rgb I": (1, 2, 3)})
    scene.move(lamp, numpy.eye(4))
    pixels: NDArray[numpy.float32] = scene.render(size="4x4", spp=1)
    with scene.rendering(spp=4) as rendering:
        rendering.advance(1)
        depth: dict[str, NDArray[numpy.float32]] = rendering.channels()
END
    cat >wrong.py <<'END'
import afterglow

context = afterglow.Context(threads="four")
scene = context.scene()
scene.light(1)
name: str = scene.shape("sphere")
scene.nothing()
END
    types=(mypy --strict --follow-imports silent --cache-dir "$folder/mypy" --no-error-summary)
    MYPYPATH=typed "${types[@]}" right.py || fail "right calls are wrong by their types"
    ! MYPYPATH=typed "${types[@]}" wrong.py >said || fail "wrong calls are right by their types"
    [[ $(grep -c '^wrong.py:.*: error: ' said) == 4 ]] || fail "not four errors: $(<said)"
    echo "ok: types, by mypy"
else
    echo "SKIPPED: mypy is not installed"
fi

check_readme_python
echo "ok: README"

"$python" - <<'END' || fail "too many threads are not told"
import resource
import afterglow

with open("/proc/self/statm") as file:
    limit = int(file.read().split()[0]) * resource.getpagesize() + (64 << 20)
resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
try:
    afterglow.Context(threads=1000)
except afterglow.Error as error:
    assert "1000 threads" in str(error) and "limits" in str(error), error
else:
    raise AssertionError("a thousand threads in 64 MB")
END
echo "ok: too many threads"

cat >scene.pbrt <<'END'
Transform [1 0 0 0  0 1 0 0  0 0 1 0  0 0 3 1] Camera "perspective" "float fov" 60
WorldBegin
LightSource "point" "rgb I" [9 9 9] "point3 from" [1 1 -2]
MakeNamedMaterial "clay" "string type" "diffuse" "rgb reflectance" [0.7 0.4 0.3]
NamedMaterial "clay"
Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] "integer indices" [0 1 2 0 2 3]
END
"$AFTERGLOW_PROGRAM" -q --size 40x30 --spp 4 --noise 0 --photons 2000 -o program.pfm scene.pbrt
"$python" - <<'END'
import ctypes, gc, os, signal, weakref
import numpy, afterglow

def refused(kind, text, function, *arguments, **named):
    try:
        function(*arguments, **named)
    except kind as error:
        assert text in str(error), f"'{text}' is not in: {error}"
        return
    raise AssertionError(f"no {kind.__name__}: {text}")

away = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -3], [0, 0, 0, 1]]
corners = numpy.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], numpy.float32)
triangles = numpy.array([[0, 1, 2], [0, 2, 3]], numpy.int32)
picture = dict(size="40x30", spp=4, noise=0, photons=2000)

def fill(scene):
    scene.camera("perspective", {"float fov": 60}, world_from_camera=away)
    scene.light("point", {"rgb I": (9, 9, 9), "point3 from": (1, 1, -2)})
    scene.material("clay", "diffuse", {"rgb reflectance": (0.7, 0.4, 0.3)})
    scene.shape("trianglemesh", {"point3 P": corners, "integer indices": triangles}, material="clay")

with open("program.pfm", "rb") as file:
    assert file.readline() == b"PF\n" and file.readline() == b"40 30\n" and float(file.readline()) < 0
    expected = numpy.frombuffer(file.read(), "<f4").reshape(30, 40, 3)[::-1]

phases = []
with afterglow.Context(threads=2, progress=lambda phase, fraction: phases.append((phase, fraction))) as context:
    with context.scene() as scene:
        fill(scene)
        pixels = scene.render(**picture)
        assert pixels.dtype == numpy.float32 and pixels.shape == (30, 40, 3) and pixels.max() > 0
        assert numpy.array_equal(pixels, expected), "another picture than the program's"
        assert phases and phases[-1][1] == 1.0
        scene.camera("perspective", {"float fov": 30}, world_from_camera=away)
        assert not numpy.array_equal(scene.render(**picture), pixels)
        refused(afterglow.Error, "is complete already", scene.light, "point")
        refused(ValueError, "there is no such setting", scene.render, sise="1x1")
        scene.camera("perspective", {"float fov": 60}, world_from_camera=away)
        with scene.rendering(aov="Z,A", **picture) as rendering:
            assert rendering.shape == (30, 40) and rendering.watch() is None
            rendering.advance(1)
            first = rendering.watch().copy()
            assert rendering.watch() is None and rendering.sample_counts() == (1, 1, 1.0)
            rendering.advance(4)
            assert numpy.array_equal(rendering.pixels(), pixels) and numpy.array_equal(rendering.watch(), pixels)
            assert not numpy.array_equal(first, pixels)
            channels = rendering.channels()
            assert set(channels) == {"R", "G", "B", "A", "Z"} and numpy.array_equal(channels["R"], pixels[..., 0])
            assert abs(channels["Z"][15, 20] - 3) < 0.01
    with context.load("scene.pbrt") as scene:
        assert numpy.array_equal(scene.render(**picture), pixels)
    # vertices that move while the shutter is open
    pictures = []
    for steps, borrow in ((2, False), (2, True), (1, False)):
        swing = afterglow.vertices(4 * steps).reshape(steps, 4, 3)
        swing[:] = corners
        swing[-1] += numpy.float32((0.0 if steps == 1 else 0.5, 0, 0))
        with context.scene() as scene:
            scene.camera("perspective", {"float fov": 60}, world_from_camera=away)
            scene.light("point", {"rgb I": (9, 9, 9), "point3 from": (1, 1, -2)})
            scene.shape("trianglemesh", {"point3 P": swing, "integer indices": triangles, "integer motionsteps": steps},
                        borrow=borrow)
            pictures.append(scene.render(**picture))
    assert numpy.array_equal(pictures[0], pictures[1]) and not numpy.array_equal(pictures[0], pictures[2])
    # matrices of more than two times: there and back
    pictures, there, back = [], numpy.eye(4), numpy.eye(4)
    there[0, 3] = 1
    for ends in (None, back, there, (there, back), numpy.array([there, back])):
        for as_instance in (False, True):
            with context.scene() as scene:
                scene.camera("perspective", {"float fov": 60}, world_from_camera=away)
                scene.light("point", {"rgb I": (9, 9, 9), "point3 from": (1, 1, -2)})
                scene.shape("trianglemesh", {"point3 P": corners, "integer indices": triangles},
                            object="o" if as_instance else None, world_from_shape_end=None if as_instance else ends)
                if as_instance:
                    scene.instance("o", None, ends)
                pictures.append(scene.render(**picture))
    assert numpy.array_equal(pictures[0], pictures[2]) and numpy.array_equal(pictures[6], pictures[8])
    assert numpy.array_equal(pictures[7], pictures[9])
    for k in (4, 5, 6, 7):
        assert numpy.abs(pictures[k] - pictures[0]).mean() > 0.1 * pictures[0].mean()
    assert numpy.abs(pictures[4] - pictures[6]).mean() < 0.5 * numpy.abs(pictures[4] - pictures[0]).mean()
    with context.scene() as scene:
        for wrong in (numpy.eye(3), numpy.zeros((0, 4, 4)), numpy.zeros((2, 16))):
            try:
                scene.shape("sphere", world_from_shape_end=wrong)
                assert False, "a wrong shape of matrices is taken"
            except ValueError as error:
                assert "4 x 4" in str(error)
    # strands whose points move
    strand = numpy.array([[0, -1, 0], [0, -0.3, 0], [0, 0.3, 0], [0, 1, 0]], numpy.float32)
    pictures = []
    for points in (strand, numpy.array([strand, strand + numpy.float32((0.8, 0, 0))])):
        with context.scene() as scene:
            scene.camera("perspective", {"float fov": 60}, world_from_camera=away)
            scene.light("point", {"rgb I": (9, 9, 9), "point3 from": (1, 1, -2)})
            scene.shape("curve", {"point3 P": points, "float width": 0.5, "integer motionsteps": len(points) if points.ndim == 3 else 1})
            pictures.append(scene.render(**picture))
    assert pictures[0].mean() > 0 and numpy.abs(pictures[1] - pictures[0]).mean() > 0.2 * pictures[0].mean()
    # changes, in the end back to the picture above; arrays that are borrowed, and written to
    mesh = afterglow.vertices(4)
    mesh[:] = corners + 0.25
    with context.scene(editable=True) as scene:
        scene.camera("perspective", {"float fov": 60}, world_from_camera=away)
        lamp = scene.light("point", {"rgb I": (1, 2, 3), "point3 from": (1, 1, -2)})
        scene.material("clay", "diffuse", {"rgb reflectance": (0.1, 0.1, 0.1)})
        arrays = {"point3 P": mesh, "integer indices": triangles}
        wall = scene.shape("trianglemesh", arrays, material="clay", borrow=True)
        ball = scene.shape("sphere", {"float radius": 0.1})
        assert lamp and wall and len({lamp, wall, ball}) == 3
        assert not numpy.array_equal(scene.render(**picture), pixels)
        assert scene.commit_counts() == dict(commits=1, meshes_made=1, trees_built=1, trees_kept=0, pictures_read=0,
                                             pictures_kept=0)
        scene.light("point", {"rgb I": (9, 9, 9), "point3 from": (1, 1, -2)}, instead_of=lamp)
        scene.material("clay", "diffuse", {"rgb reflectance": (0.7, 0.4, 0.3)}, instead=True)
        scene.material("spare", "diffuse")
        scene.assign(wall, "spare")
        scene.complete()
        assert scene.commit_counts()["trees_kept"] == 1 and scene.commit_counts()["meshes_made"] == 1
        scene.move(ball, [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        scene.remove(ball)
        scene.assign(wall, "clay")
        scene.remove_named("material", "spare")
        mesh[:] = corners
        scene.shape("trianglemesh", arrays, material="clay", borrow=True, instead_of=wall)
        assert numpy.array_equal(scene.render(**picture), pixels), "another picture than that of a scene made afresh"
        refused(afterglow.Error, "nothing has this handle any more", scene.remove, ball)
        refused(afterglow.Error, "there is no material \"spare\"", scene.material, "spare", "diffuse", instead=True)
        scene.assign(wall, "nothing")
        refused(afterglow.Error, "no material is named \"nothing\"", scene.complete)
        assert numpy.array_equal(scene.render(**picture), pixels), "what failed is not dropped"
        for wrong in (corners, mesh.astype(float), mesh[:, ::-1], mesh.tolist()):
            refused(ValueError, "a borrowed array", scene.shape, "trianglemesh",
                    {"point3 P": wrong, "integer indices": triangles}, borrow=True)
        room = numpy.zeros(64, numpy.uint8)
        skewed = room[1:49].view(numpy.float32).reshape(4, 3)
        skewed[:] = corners
        refused(ValueError, "aligned", scene.shape, "trianglemesh",
                {"point3 P": skewed, "integer indices": triangles}, borrow=True)
        copied = scene.shape("trianglemesh", {"point3 P": skewed, "integer indices": triangles}, material="clay",
                             instead_of=wall)
        assert copied == wall and numpy.array_equal(scene.render(**picture), pixels)
        with scene.rendering(**picture):
            refused(afterglow.Error, "a rendering of it is not finished yet", scene.remove, wall)
        for _ in range(50):
            scene.remove(scene.shape("trianglemesh", arrays, borrow=True))
        scene.complete()
        assert not scene._lent and not scene._lent_since, "arrays are kept that nobody borrows"
    with context.load_text(open("scene.pbrt").read()) as scene:
        assert numpy.array_equal(scene.render(**picture), pixels)
    with context.scene(editable=True) as scene:
        refused(ValueError, '"sepia" is none of: film, sampler, integrator, pixelfilter', scene.hint, "Sepia", "rgb")
        refused(ValueError, "none of: float, spectrum", scene.texture, "t", "color", "constant")
        refused(ValueError, "none of: material, medium, float texture, ", scene.remove_named, "shape", "t")
        scene.hint("PixelFilter", "box")
        scene.texture("t", "float", "constant")
        refused(afterglow.Error, "the scene is not committed yet", scene.remove_named, "float texture", "t")
    refused(afterglow.Error, "missing.pbrt: error: cannot read the file", context.load, "missing.pbrt")
    with context.scene() as scene:
        refused(afterglow.Error, "index 9 (value 3", scene.shape, "trianglemesh",
                {"point3 P": corners, "integer indices": [0, 1, 9]})
        refused(afterglow.Error, "is not finite", scene.shape, "sphere", {"float radius": float("nan")})
        refused(ValueError, "no \"type name\"", scene.shape, "sphere", {"radius": 1})
        refused(ValueError, "no integers", scene.shape, "trianglemesh", {"integer indices": [0.5]})
        refused(ValueError, "4 x 4", scene.shape, "sphere", world_from_shape=[1, 2, 3])
        scene.image("checks", numpy.array([[0, 255], [255, 0]], numpy.uint8))
        scene.texture("t", "spectrum", "imagemap", {"string filename": "checks"})
        scene.material("checked", "diffuse", {"texture reflectance": "t"})
        fill(scene)
        scene.shape("sphere", {"float radius": numpy.float32(0.25)}, material="checked", object="ball")
        for x in (-0.5, 0.5):
            scene.instance("ball", [[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, -0.5], [0, 0, 0, 1]])
        assert not numpy.array_equal(scene.render(**picture), pixels)

# Borrowed arrays live as long as the library reads them, whatever is raised meanwhile.
raises = []

def raise_one(*_):
    if raises:
        raise raises.pop()

def lend(scene, **named):
    mesh = afterglow.vertices(4)
    mesh[:] = corners + 0.125 * len(named)
    handle = scene.shape("trianglemesh", {"point3 P": mesh, "integer indices": triangles}, borrow=True, **named)
    return handle, weakref.ref(mesh)

with afterglow.Context(threads=2, progress=raise_one) as context, context.scene(editable=True) as scene:
    scene.camera("perspective", {"float fov": 60}, world_from_camera=away)
    scene.light("point", {"rgb I": (9, 9, 9), "point3 from": (1, 1, -2)})
    handle, mesh = lend(scene)
    before = scene.render(**picture)
    for _ in range(3):
        _, other = lend(scene, instead_of=handle)
        raises.append(KeyError("own"))
        refused(KeyError, "own", scene.complete)
        scene.complete()
        gc.collect()
        assert mesh() is not None and other() is None, "not the arrays that the library borrows are kept"
        assert numpy.array_equal(scene.render(**picture), before)
    _, other = lend(scene, instead_of=handle)
    scene.complete()
    gc.collect()
    assert mesh() is None and other() is not None

def offend(message):
    raise UserWarning(message)

with afterglow.Context(threads=2, warn=offend) as context, context.scene(editable=True) as scene:
    scene.camera("perspective", {"float fov": 60}, world_from_camera=away)
    scene.complete()
    mesh = afterglow.vertices(4)
    mesh[:] = corners
    seen = weakref.ref(mesh)
    refused(UserWarning, "nonsense", scene.shape, "trianglemesh",
            {"point3 P": mesh, "integer indices": triangles, "float nonsense": 1.0}, borrow=True)
    del mesh
    gc.collect()
    assert seen() is not None, "the library borrows what is gone"
    scene.light("point", {"rgb I": (9, 9, 9), "point3 from": (1, 1, -2)})
    assert scene.render(**picture).max() > 0

# What is closed is not handed to the library; arguments of another type do not keep it waiting.
context = afterglow.Context()
scene, other = context.load("scene.pbrt"), context.load("scene.pbrt")
rendering, denoised = scene.rendering(**picture), other.rendering(**picture)
refused(TypeError, "integer", rendering.advance, 4.0)
refused(ctypes.ArgumentError, "", context._work, afterglow._library.ag_rendering_continue, None, 1.5)
rendering.advance(numpy.int64(4))
assert numpy.array_equal(rendering.pixels(), pixels)
refused(afterglow.Error, "", denoised.denoise)  # its settings do not ask for it
refused(afterglow.Error, "the rendering is closed", denoised.sample_counts)
refused(afterglow.Error, "the rendering is closed", denoised.denoise)
scene.close()
for use in (rendering.pixels, rendering.channels, rendering.watch, rendering.sample_counts, rendering.denoise):
    refused(afterglow.Error, "the rendering is closed", use)
refused(afterglow.Error, "the rendering is closed", rendering.advance, 8)
refused(afterglow.Error, "the scene is closed", scene.rendering)
context.close()
refused(afterglow.Error, "the scene is closed", other.light, "point")
refused(afterglow.Error, "the context is closed", other.render)
refused(afterglow.Error, "the rendering is closed", denoised.pixels)
refused(afterglow.Error, "the context is closed", context.scene)
refused(afterglow.Error, "the context is closed", context.cancel)
for each in (rendering, denoised, scene, other, context):
    each.close()

class Enough(Exception):
    pass

def stop(phase, fraction):
    if phase == 5:  # AG_PHASE_RENDER
        raise Enough

def stop_here():
    raise Enough

with afterglow.Context() as context, context.load("scene.pbrt") as scene:
    with scene.rendering(**{**picture, "spp": 100000}) as rendering:
        refused(Enough, "", rendering.advance, 100000, stop_here)
    assert numpy.array_equal(scene.render(**picture), pixels)

for threads in (-1, 1 << 32):
    refused(ValueError, f"threads: {threads} is not in", afterglow.Context, threads)

said = []
with afterglow.Context(warn=said.append) as context, context.scene() as scene:
    scene.light("point", {"float unknown": 1})
assert len(said) == 1 and "unknown" in said[0], said

with afterglow.Context(progress=stop) as context, context.load("scene.pbrt") as scene:
    refused(Enough, "", scene.render, **picture)
    refused(Enough, "", scene.render, **picture)  # the context goes on

# Ctrl-C, which Python hears on its main thread.
interrupts = []
def interrupt(phase, fraction):
    if phase == 5 and not interrupts:
        interrupts.append(phase)
        os.kill(os.getpid(), signal.SIGINT)

signal.signal(signal.SIGINT, signal.default_int_handler)
with afterglow.Context(progress=interrupt) as context, context.load("scene.pbrt") as scene:
    refused(KeyboardInterrupt, "", scene.render, **{**picture, "spp": 100000})
    assert numpy.array_equal(scene.render(**picture), pixels)
END
echo "ok: scenes, errors, cancellation"

"$python" - <<'END' || fail "what is called while the context is at work"
import afterglow, numpy

def refused(kind, text, function, *arguments):
    try:
        function(*arguments)
    except kind as error:
        assert text in str(error), f"'{text}' is not in: {error}"
        return
    raise AssertionError(f"no {kind.__name__}: {text}")

with afterglow.Context(threads=2) as context, context.scene(editable=True) as scene:
    scene.camera("perspective")
    lamp = scene.light("point")
    scene.shape("trianglemesh", {"point3 P": [[-1, -1, 2], [1, -1, 2], [0, 1, 2]], "integer indices": [0, 1, 2]})
    refused(ValueError, "a NUL", scene.material, "a\0b", "diffuse")
    with scene.rendering(size="64x64", spp=1 << 14, photons=100, caustic_photons=10, noise=0) as rendering:
        # what a callback calls would work with the context a second time, or take away what is at work
        for call in (lambda: rendering.advance(3), rendering.close, rendering.denoise, scene.close, context.close,
                     scene.render, lambda: scene.remove(lamp), lambda: scene.camera("perspective"),
                     lambda: context.load_text("WorldBegin"), context.scene):
            refused(afterglow.Error, "is at work", rendering.advance, 1 << 14, call)
        rendering.advance(4, rendering.watch)
        assert rendering.sample_counts()[0] >= 4 and numpy.isfinite(rendering.pixels()).all()
    scene.remove(lamp)
    scene.light("point")
    assert scene.render(size="8x8", spp=1, photons=100).max() > 0
END
echo "ok: calls while it is at work"
