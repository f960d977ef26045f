# SPDX-License-Identifier: Apache-2.0
"""Relief bakes meshes into depth maps for collisions with points and particles.

    import relief
    collider = relief.bake("bunny.obj", budget=1_000_000)
    distance, normal, which = collider.query(points)      # (n,), (n, 3), (n,)
    collider.save("bunny.relief")
    print(relief.check(collider, "bunny.obj").wrong_percent)

Points and vertices are arrays of shape (n, 3); triangles are arrays of indices of shape (n, 3). Lengths are in the units of
the mesh, times in seconds. Long operations release the GIL, use all cores and end on Ctrl-C. Errors are relief.Error or its
subclasses. relief.UsageError, which is also a ValueError, names the argument and the fix. An argument of a wrong type raises
TypeError.
"""
from __future__ import annotations

import dataclasses
import difflib
import functools
import inspect
import os
import re
import warnings
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, NoReturn, Optional, TypeVar, Union

import numpy as np

from . import _relief
from ._relief import Error, FileError, InputError, LimitError, UnsupportedError, UsageError

__version__: str = _relief.version
__all__ = ["Accuracy", "Collider", "DepthMap", "Error", "FileError", "Hits", "InputError", "LimitError", "ReliefWarning",
           "Samples", "Simulation", "UnsupportedError", "UsageError", "World", "WorldSamples", "WorstPlace", "bake",
           "check", "load"]

Path = Union[str, "os.PathLike[str]"]
Number = Union[int, float, str]
"""A number or a string as on the command line: 1, 1.5, "1%"; for bytes also "1MB"."""


class _Field(NamedTuple):
    """A field of a bake or check request."""

    name: str
    kind: str
    about: str


def _named(fields: list[tuple[str, str, str]]) -> dict[str, _Field]:
    """Returns the fields by argument name. "map" and "as" are renamed, because Python defines them."""
    return {{"map": "maps", "as": "as_"}.get(field[0], field[0]): _Field(*field) for field in fields}


_BAKE = _named(_relief.bake_fields())
_CHECK = _named(_relief.check_fields())
_ARGUMENTS = {"--" + field.name.replace("_", "-"): name for name, field in {**_BAKE, **_CHECK}.items()}


_Function = TypeVar("_Function", bound=Callable[..., Any])


def _hinting(function: _Function) -> _Function:
    """Wraps a function so that the error about an unknown argument suggests the nearest one."""
    known = list(inspect.signature(function).parameters)
    name = function.__qualname__.removesuffix(".__init__")

    @functools.wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        for argument in named:
            if argument not in known:
                near = difflib.get_close_matches(argument, known, 1)
                raise TypeError(f"{name}() has no argument {argument!r}; "
                                + (f"did you mean {near[0]!r}?" if near else f"see help(relief.{name})"))
        return function(*arguments, **named)

    return call  # type: ignore[return-value]


def __dir__() -> list[str]:
    return [*__all__, "__version__", "__doc__", "__name__", "__file__"]


class ReliefWarning(UserWarning):
    """A warning of `relief`."""


class Samples(NamedTuple):
    """A collider evaluated at n points."""

    distance: np.ndarray
    """(n,) float32: negative inside; 1e30: outside at an unknown distance, or no map votes; NaN: the point is not
    finite."""
    normal: np.ndarray
    """(n, 3) float32, outwards; zero where distance is 1e30; NaN: the point is not finite."""
    map: np.ndarray
    """(n,) int32: the map that decides; -1 if no map votes."""


class WorldSamples(NamedTuple):
    """A world evaluated at n points."""

    distance: np.ndarray
    """(n,) float32: as Samples.distance, in world units; the minimum over all bodies."""
    normal: np.ndarray
    """(n, 3) float32: as Samples.normal, in world space."""
    body: np.ndarray
    """(n,) int32: the body that decides; -1 if no body votes."""


class DepthMap:
    """A map of a collider. Its arrays keep the collider alive."""

    def __init__(self, collider: "Collider", index: int) -> None:
        self._collider = collider
        self.index = index
        self._about = collider._handle.describe_map(index)

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["_about"][name]
        except KeyError:
            raise AttributeError(name) from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._about]

    @property
    def texels(self) -> np.ndarray:
        """(faces, height, width, 4), read-only, without a copy: uint8, uint16 or float32, depending on the format
        (formats/README.md). For a map of patches these are the words of its tree, not an image."""
        return self._collider._handle.map_texels(self.index)

    @property
    def depth(self) -> np.ndarray:
        """(faces, height, width) float32: 0 at the near plane, 1 at the far plane; for a cube, the distance from its centre.
        NaN without a surface. Row 0 is y = 0. Not available for a map of patches."""
        return self._depth(False)

    @property
    def back_depth(self) -> np.ndarray:
        """The depth of the far surface of a front-back map."""
        return self._depth(True)

    def _depth(self, back: bool) -> np.ndarray:
        if self.format == "patches":
            raise UsageError(f"map {self.index} has patches and no depth image; use texels for the words of its tree")
        return self._collider._handle.map_depth(self.index, back)

    def __repr__(self) -> str:
        return f"<DepthMap {self.index}: {self.format}, {self.width} x {self.height}>"


def _of_handle(name: str, about: str) -> Any:
    return property(lambda self: getattr(self._handle, name), doc=about)


class Collider:
    """Depth maps that represent an object; made by bake() and load(). Immutable, so copies are the same object; can be
    pickled."""

    def __init__(self, handle: Any) -> None:
        if not isinstance(handle, _relief.Collider):
            raise TypeError("colliders are made by relief.bake() and relief.load()")
        self._handle = handle

    def __copy__(self) -> "Collider":
        return self

    def __deepcopy__(self, memo: Any) -> "Collider":
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return load, (self.to_bytes(),)

    bounds = _of_handle("bounds", "(2, 3): the minimum and maximum corners of the mesh's bounds.")
    unit = _of_handle("unit", 'Unit of lengths: "m", or "" if the mesh has none.')
    options = _of_handle("options", "The options of its bake, as for `relief bake`.")
    gpu_bytes = _of_handle("gpu_bytes", "Size of its maps on a GPU, bytes.")

    @property
    def maps(self) -> list[DepthMap]:
        return [DepthMap(self, i) for i in range(self._handle.map_count)]

    @_hinting
    def query(self, points: Any, distance: str = "plane") -> Samples:
        """Evaluates the collider at points, (n, 3).

        distance: "plane": to the plane that decides the side, as in collisions of particles; "nearest": to the nearest
        surface, which takes about thirteen times as long.
        """
        if distance not in ("plane", "nearest"):
            raise UsageError(f"distance is {distance!r} but must be 'plane' or 'nearest'")
        return Samples(*self._handle.query(_coordinates(points, "points"), distance))

    @_hinting
    def save(self, path: Path, compress: int = 0) -> None:
        """Writes a .relief file atomically. compress: zstd level, 1 to 19; 0: none."""
        _relief.save(self._handle, _path(path), _whole(compress, "compress", 0, 19))

    @_hinting
    def to_bytes(self, compress: int = 0) -> bytes:
        """Returns the bytes that save() writes, for load()."""
        return _relief.to_bytes(self._handle, _whole(compress, "compress", 0, 19))

    def __repr__(self) -> str:
        return f"<Collider of {self._handle.mesh_name or 'a mesh'}: {self._handle.map_count} maps, {self.gpu_bytes} bytes>"


class World:
    """The world.json of `relief bake --world`, with its colliders. Bodies have the order of the file. Immutable: arrays are
    copies."""

    @_hinting
    def __init__(self, path: Path) -> None:
        self._handle = _relief.load_world(_path(path))
        self._nodes = list(self._handle.nodes)

    bounds = _of_handle("bounds", "(2, 3): the minimum and maximum corners of the bounds of all bodies.")
    unit = _of_handle("unit", 'Unit of lengths: "m", or "" if the level has none.')
    positions = _of_handle("positions", "(n, 3) float32: the position of each body's collider origin.")
    rotations = _of_handle("rotations", "(n, 4) float32: the rotation of each body, a unit quaternion x, y, z, w.")
    scales = _of_handle("scales", "(n,) float32: world units per unit of each body's collider.")
    collider_of = _of_handle("collider_of", "(n,) uint32: the index of each body's collider.")

    @property
    def nodes(self) -> list[str]:
        """The name of each body's node; may be empty."""
        return list(self._nodes)

    @property
    def colliders(self) -> list[Collider]:
        """The distinct colliders."""
        return [Collider(self._handle.collider(i)) for i in range(self._handle.collider_count)]

    def find(self, node: str) -> list[int]:
        """Returns the indices of all bodies whose node has this name; a mesh that was cut into tiles has several."""
        if not isinstance(node, str):
            _wrong_type(node, "node", "text")
        if node not in self._nodes:
            raise UsageError(f"node is {node!r}, but no body of the world has a node of this name; see nodes")
        return [body for body, name in enumerate(self._nodes) if name == node]

    def query(self, points: Any) -> WorldSamples:
        """Evaluates the union of all bodies at points, (n, 3), in world space. Time is proportional to the number of bodies."""
        return WorldSamples(*self._handle.query(_coordinates(points, "points")))

    def __len__(self) -> int:
        return len(self._nodes)

    def __repr__(self) -> str:
        return f"<World: {len(self)} bodies of {self._handle.collider_count} colliders>"


@dataclasses.dataclass(frozen=True)
class WorstPlace:
    """A part of the surface with many points near it on the wrong side."""

    position: tuple[float, float, float]
    """A point on the wrong side, surrounded by others."""
    size: float
    """Longest side of the box of its points on the wrong side."""
    contribution_percent: float
    """Percentage of all wrong points near the surface."""
    false_inside_percent: float
    """Percentage of its points that are classified as inside."""
    map: int
    """Map that decides most of them; -1: no map votes."""
    cause: str
    """ "sheet", "open", "unseen", "silhouette" or "texel", as in `relief check --json`."""


@dataclasses.dataclass(frozen=True)
class Accuracy:
    """The accuracy of a collider against a mesh."""

    false_inside_percent: float
    """Percentage of points near the surface that are wrongly classified as inside."""
    false_outside_percent: float
    """Percentage of points near the surface that are wrongly classified as outside."""
    distance_error_mean: float
    """Mean error of the distance near the surface, in the mesh's units."""
    distance_error_p99: float
    normal_error_mean: float
    """Mean error of normals on the surface, degrees."""
    unknown_percent: float
    """Percentage of points near the surface without a vote."""
    lost_parts: int
    """Parts of the mesh with more than a quarter of their points on the wrong side, relative to the size of the part."""
    ignored_parts: int
    """Parts that are lost or thicker than in the mesh, but too small or too slightly off to lower the grade."""
    grade: str
    """ "good", "fair" or "poor", as in `relief check`: the worse of the grades of the whole mesh and of its parts. A lost part
    is poor. Coarse parts lower the grade to "fair" if they and the ignored parts together miss more than 1 % of the points near
    the surface. Ignored parts by themselves do not lower it."""
    proven_depth: float | None = None
    """No point farther than this from every triangle is on the wrong side, in the mesh's units; None if it is not proven."""
    worst_places: tuple[WorstPlace, ...] = ()
    """The worst first; at most three."""

    @property
    def wrong_percent(self) -> float:
        return self.false_inside_percent + self.false_outside_percent


def _wrong_type(value: Any, name: str, expected: str) -> NoReturn:
    raise TypeError(f"{name} is of type {type(value).__name__} but must be {expected}")


def _path(value: Any, name: str = "path") -> str:
    if not isinstance(value, (str, os.PathLike)):
        _wrong_type(value, name, "a path")
    path = os.fsdecode(value)
    if "\0" in path:
        raise UsageError(f"{name} contains a null character; remove it")
    return "./-" if path == "-" else path  # "-" means standard input and output


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


def _is_whole(value: Any) -> bool:
    return bool(np.isfinite(float(value)) if isinstance(value, (float, np.floating)) else True) and value == int(value)


def _whole(value: Any, name: str, least: int, most: int) -> int:
    """Validates a whole number; accepts integral floats."""
    if not _is_number(value):
        _wrong_type(value, name, "a whole number")
    if not _is_whole(value) or not least <= value <= most:
        raise UsageError(f"{name} is {value} but must be a whole number from {least} to {most}")
    return int(value)


def _array(values: Any, name: str, kinds: str, expected: str) -> np.ndarray:
    """Returns the values as an array of shape (n, 3) with one of the given numpy kinds."""
    if np.ma.is_masked(values):
        raise UsageError(f"{name} are partly masked; fill the masked values, or remove them")
    try:
        array = np.asarray(values)
    except ValueError:
        raise UsageError(f"{name} must be an array of shape (n, 3), not rows of different lengths") from None
    if array.ndim != 2 or array.shape[1] != 3:
        raise UsageError(f"{name} must be an array of shape (n, 3), not {array.shape}")
    if array.dtype.kind not in kinds:
        raise TypeError(f"{name} must be an array of {expected}, not of {array.dtype}")
    return array


def _coordinates(values: Any, name: str) -> np.ndarray:
    array = _array(values, name, "fiu", "numbers")
    with np.errstate(over="ignore"):  # overflow gives infinity, which is rejected later
        return np.ascontiguousarray(array, dtype=np.float32)


def _source(mesh: Any, triangles: Any, name: str) -> tuple[Optional[str], np.ndarray, np.ndarray, bytes]:
    """Returns a mesh for the module: the path of a file, or vertices and triangles."""
    if isinstance(mesh, (str, os.PathLike)):
        if triangles is not None:
            raise UsageError("triangles cannot be given for a mesh file; remove them")
        return _path(mesh, "mesh"), np.empty((0, 3), np.float32), np.empty((0, 3), np.uint32), b""
    if triangles is None:
        raise UsageError("triangles are missing; give them with the vertices")
    if not isinstance(name, str):
        _wrong_type(name, "name", "text")
    positions = _coordinates(mesh, "vertices")
    corners = _array(triangles, "triangles", "iu", "indices, whole numbers of an integer type")
    if corners.size and corners.min() < 0:
        raise UsageError("triangles must be vertex indices of at least 0")
    if corners.size and corners.max() > np.iinfo(np.uint32).max:
        raise InputError(f"{name}: a triangle uses vertex {corners.max()} but there are {len(positions)}; export it again")
    return None, positions, np.ascontiguousarray(corners, dtype=np.uint32), name.encode(errors="replace")


def _word(value: Any, name: str) -> str:
    if isinstance(value, (str, os.PathLike)):
        return os.fsdecode(value)
    if not _is_number(value):
        _wrong_type(value, name, "a number or text")
    return str(int(value)) if _is_whole(value) else repr(float(value))


def _words(fields: dict[str, _Field], arguments: dict[str, Any]) -> list[tuple[str, bytes]]:
    """Returns the arguments as words for the fields of a request."""
    words = []
    for name, field in fields.items():
        value = arguments[name]
        if value is None:
            continue
        if field.kind == "flag":
            if not isinstance(value, (bool, np.bool_)):
                _wrong_type(value, name, "True or False")
            texts = ["true"] if value else []
        elif field.kind == "list" and not isinstance(value, str):
            if not isinstance(value, Sequence) or not all(isinstance(one, str) for one in value):
                _wrong_type(value, name, "text or a list of texts")
            texts = list(value)
        else:
            texts = [_word(value, name)]
        if any("\0" in text for text in texts):
            raise UsageError(f"{name} contains a null character; remove it")
        words += [(field.name, os.fsencode(text)) for text in texts]
    return words


def _in_python(text: str) -> str:
    """Replaces the options in a message with the names of arguments."""
    return re.sub(r"(?<![\w'-])--[a-z][a-z-]*[a-z]", lambda found: _ARGUMENTS.get(found[0], found[0]), text)


def _run(work: Callable[..., tuple[Any, list[str]]], *arguments: Any) -> Any:
    """Calls the module; converts options in its messages to arguments, and its warnings to Python warnings."""
    try:
        result, messages = work(*arguments)
    except Error as error:
        raise type(error)(_in_python(str(error))) from None
    for text in messages:
        warnings.warn(_in_python(text), ReliefWarning, stacklevel=4)
    return result


@_hinting
def bake(mesh: Any, triangles: Any = None, *, name: str = "mesh",
         # generated: bake-arguments by scripts/generate.sh
         maps: Union[str, Sequence[str], None] = None,
         decode: Optional[str] = None,
         depth: Optional[str] = None,
         paper: bool = False,
         resolution: Optional[Number] = None,
         budget: Optional[Number] = None,
         texel: Optional[Number] = None,
         max_error: Optional[Number] = None,
         quality: Optional[str] = None,
         prefer: Optional[str] = None,
         threads: Optional[Number] = None,
         holes: Optional[str] = None,
         no_check: bool = False,
         unit: Optional[str] = None,
         up: Optional[str] = None,
         hidden: Optional[str] = None,
         max_import_memory: Optional[Number] = None,
         import_timeout: Optional[Number] = None,
         max_triangles: Optional[Number] = None,
         strict: bool = False,
         repair: Optional[str] = None,
         as_: Union[str, Sequence[str], None] = None,
         thickness: Optional[Number] = None,
         voids: Optional[str] = None,
         materials: Optional[str] = None,
         animated: bool = False,
         clips: Union[str, Sequence[str], None] = None,
         heights: Optional[str] = None,
         timeout: Optional[Number] = None,
         # end of bake-arguments by scripts/generate.sh
         ) -> Collider:
    """Bakes a mesh like `relief bake`, with the same options, defaults and bytes.

    mesh: the path of a file, read in a sandboxed process; or vertices, (n, 3), with triangles, (m, 3).
    name: the name of the mesh in the container, if it is not a file.

    Warnings are ReliefWarnings. The other arguments are the options of `relief bake`:
    """
    words = _words(_BAKE, locals())
    return Collider(_run(_relief.bake, words, *_source(mesh, triangles, name)))


@_hinting
def load(source: Union[Path, bytes, bytearray, memoryview]) -> Collider:
    """Loads a collider from a .relief file or its bytes."""
    if isinstance(source, (bytes, bytearray, memoryview)):
        return Collider(_relief.read(bytes(source)))
    return Collider(_relief.load(_path(source, "source")))


@_hinting
def check(collider: Collider, mesh: Any, triangles: Any = None, *,
          # generated: check-arguments by scripts/generate.sh
          samples: Optional[Number] = None,
          seed: Optional[Number] = None,
          min_part: Optional[Number] = None,
          unit: Optional[str] = None,
          up: Optional[str] = None,
          hidden: Optional[str] = None,
          max_import_memory: Optional[Number] = None,
          import_timeout: Optional[Number] = None,
          max_triangles: Optional[Number] = None,
          # end of check-arguments by scripts/generate.sh
          ) -> Accuracy:
    """Measures the accuracy of a collider at random points around the mesh that it was baked from: a file, or vertices and
    triangles.

    The verdict is that of `relief check`: against the mesh as baked, which is the repaired mesh if the bake repaired it. The
    other arguments are the options of `relief check`:
    """
    if not isinstance(collider, Collider):
        _wrong_type(collider, "collider", "a relief.Collider")
    words = _words(_CHECK, locals())
    measured = _run(_relief.check, collider._handle, words, *_source(mesh, triangles, "mesh"))
    return Accuracy(**{**measured, "worst_places": tuple(WorstPlace(**place) for place in measured["worst_places"])})


for _function, _fields in ((bake, _BAKE), (check, _CHECK)):
    _function.__doc__ = inspect.cleandoc(_function.__doc__ or "") + "\n\n" + "\n".join(
        f"{_name}: {_field.about}" for _name, _field in _fields.items())


class Hits(NamedTuple):
    """n hits. A hit is a contact of a particle that touched nothing in the previous step."""

    step: np.ndarray
    """(n,) uint64: the step, from 1, ascending."""
    time: np.ndarray
    """(n,) float64: seconds since the start of the simulation."""
    id: np.ndarray
    """(n,) uint32: the id of the particle, as in Simulation.ids."""
    type: np.ndarray
    """(n,) uint32: as in Simulation.types."""
    body: np.ndarray
    """(n,) int32: index of the scene's collider; -1: the ground."""
    material: np.ndarray
    """(n,) int32: index into Simulation.materials; -1: the ground, or a collider without materials."""
    position: np.ndarray
    """(n, 3) float32: contact point."""
    normal: np.ndarray
    """(n, 3) float32: surface normal, out of the body."""
    velocity: np.ndarray
    """(n, 3) float32: velocity of the particle before the contact."""
    speed: np.ndarray
    """(n,) float32: speed of approach along the normal, relative to the surface."""


def _of_state(name: str, about: str) -> Any:
    return property(lambda self: self._state(name), doc=about)


class Simulation:
    """A `relief-sim` scene without a window. Use it only on the thread that created it; several may share a thread."""

    @_hinting
    def __init__(self, scene: Path, *, seed: Optional[int] = None, root: Optional[Path] = None,
                 hits: bool = False) -> None:
        """seed: for every emitter, instead of the scene's. root: an additional folder whose files the scene may reference.
        hits: store hits for take_hits(), which costs time in each step."""
        self._open: Optional[_relief.Simulation] = None
        self._read: Optional[dict[str, np.ndarray]] = None
        if seed is not None:
            seed = _whole(seed, "seed", 0, 2**64 - 1)
        self._open = _relief.Simulation(_path(scene, "scene"), seed, "" if root is None else _path(root, "root"),
                                        bool(hits))
        for text in self._open.take_warnings():
            warnings.warn(_in_python(text), ReliefWarning, stacklevel=3)

    @property
    def _handle(self) -> "_relief.Simulation":
        if self._open is None:
            raise UsageError("the simulation is closed")
        return self._open

    def close(self) -> None:
        """Frees its memory, like the end of a with block."""
        self._open = self._read = None

    def __enter__(self) -> "Simulation":
        return self

    def __exit__(self, *about: Any) -> None:
        self.close()

    def step(self, count: int = 1) -> None:
        """Runs `count` steps of the scene's time step. Ctrl-C interrupts between steps."""
        count = _whole(count, "count", 0, 2**32 - 1)
        self._read = None
        self._handle.step(count)

    @property
    def materials(self) -> list[str]:
        """The names of the materials of all colliders."""
        return list(self._handle.materials)

    def take_hits(self) -> Hits:
        """Returns the hits since the last call, ordered by step; waits for the GPU. At most 262,144 per step."""
        return Hits(**self._handle.take_hits())

    time = _of_handle("time", "Simulated time, seconds.")
    alive = _of_handle("alive", "Number of living particles.")

    def _state(self, name: str) -> np.ndarray:
        handle = self._handle
        if self._read is None:
            self._read = handle.read()
        return self._read[name]

    positions = _of_state("positions", "(n, 3) float32, in the same order as the other arrays. Read back once per step.")
    velocities = _of_state("velocities", "(n, 3) float32")
    ids = _of_state("ids", "(n,) uint32: number of births before that of the particle.")
    types = _of_state("types", "(n,) uint32: index of the [[type]].")
    ages = _of_state("ages", "(n,) float32: seconds since birth.")
    lifetimes = _of_state("lifetimes", "(n,) float32: seconds from birth to death.")
    collisions = _of_state("collisions", "(n,) uint32: steps in contact so far.")
