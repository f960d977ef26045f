"""Relief: meshes baked into depth maps that points and particles collide with.

    import relief
    collider = relief.bake("bunny.obj", budget=1_000_000)
    distance, normal, which = collider.query(points)      # (n,), (n, 3), (n,)
    collider.save("bunny.relief")
    print(relief.check(collider, "bunny.obj").wrong_percent)

Points and vertices are arrays of shape (n, 3), triangles of indices (n, 3). Lengths are in the mesh's units, times in
seconds. Everything that takes long releases the GIL and uses all cores. Errors are relief.Error, or one of those derived
from it.
"""
from __future__ import annotations

import dataclasses
import os
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from . import _relief
from ._relief import Error, FileError, InputError, LimitError, UnsupportedError, UsageError

__version__: str = _relief.version
__all__ = ["Accuracy", "Collider", "DepthMap", "Error", "FileError", "Hits", "InputError", "LimitError", "Samples", "Simulation",
           "UnsupportedError", "UsageError", "WorstPlace", "bake", "check", "load"]

Path = Union[str, "os.PathLike[str]"]


class Samples(NamedTuple):
    """What a collider says of n points."""

    distance: np.ndarray
    """(n,) float32: negative inside; 1e30 where a point is outside and no more is known."""
    normal: np.ndarray
    """(n, 3) float32, outwards; zero where no more than "outside" is known."""
    map: np.ndarray
    """(n,) int32: the map that decides; -1 where no map says anything."""


class DepthMap:
    """One map of a collider. Its arrays live as long as the collider."""

    def __init__(self, collider: "Collider", index: int) -> None:
        self._collider = collider
        self.index = index
        self._about = collider._handle.describe_map(index)

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["_about"][name]
        except KeyError:
            raise AttributeError(name) from None

    @property
    def texels(self) -> np.ndarray:
        """(faces, height, width, 4), read-only and without a copy: uint8, uint16 or float32 as the format stores them
        (formats/README.md)."""
        return self._collider._handle.map_texels(self.index)

    @property
    def depth(self) -> np.ndarray:
        """(faces, height, width) float32: 0 at the near plane, 1 at the far one, of a cube the distance from its centre;
        NaN where there is no surface. Row 0 is y = 0."""
        return self._collider._handle.map_depth(self.index, False)

    @property
    def back_depth(self) -> np.ndarray:
        """The same of the far surface, of a front-back map."""
        return self._collider._handle.map_depth(self.index, True)

    def __repr__(self) -> str:
        return f"<DepthMap {self.index}: {self.format}, {self.width} x {self.height}>"


class Collider:
    """Depth maps that stand for a body; made by bake() and load()."""

    def __init__(self, handle: Any) -> None:
        self._handle = handle

    @property
    def bounds(self) -> np.ndarray:
        """(2, 3): the least and the largest corner of the mesh's box."""
        return np.array(self._handle.bounds, dtype=np.float32)

    @property
    def unit(self) -> str:
        """Of lengths: "m", or "" where the mesh does not say."""
        return self._handle.unit

    @property
    def options(self) -> str:
        """How it was baked, as options of `relief bake`."""
        return self._handle.options

    @property
    def gpu_bytes(self) -> int:
        """What its maps take on a GPU."""
        return self._handle.gpu_bytes

    @property
    def maps(self) -> list[DepthMap]:
        return [DepthMap(self, i) for i in range(self._handle.map_count)]

    def query(self, points: Any, distance: str = "plane") -> Samples:
        """What it says of points, (n, 3).

        distance: "plane": to the plane that decides the side, which is what particles collide with; "nearest": to the
        nearest surface, which is searched for, some thirteen times the work.
        """
        return Samples(*self._handle.query(np.ascontiguousarray(points, dtype=np.float32), distance))

    def save(self, path: Path, compression: int = 0) -> None:
        """Writes a .relief file, whole or not at all. compression: zstd's level, 1 to 19; 0: none."""
        _relief.save(self._handle, os.fspath(path), compression)

    def __repr__(self) -> str:
        return f"<Collider of {self._handle.mesh_name or 'a mesh'}: {self._handle.map_count} maps, {self.gpu_bytes} bytes>"


@dataclasses.dataclass(frozen=True)
class WorstPlace:
    """A part of the surface with many points near it on the wrong side."""

    position: tuple[float, float, float]
    """A point on the wrong side, in the thick of it."""
    size: float
    """Of the box of its points on the wrong side: the longest side."""
    share_percent: float
    """Of all points near the surface on the wrong side."""
    inside_percent: float
    """Of its points: called inside."""
    map: int
    """That decides most of them; -1: no map says anything."""
    cause: str
    """ "sheet", "open", "unseen", "silhouette", "texel" or "other", as `relief check --json` has it."""


@dataclasses.dataclass(frozen=True)
class Accuracy:
    """How far a collider is from a mesh."""

    false_inside_percent: float
    """Of points near the surface: outside in truth."""
    false_outside_percent: float
    """Of points near the surface: inside in truth."""
    distance_mean: float
    """Mean error of the distance near the surface, in the mesh's units."""
    distance_p99: float
    normal_mean: float
    """Mean error of normals on the surface, degrees."""
    unknown_percent: float
    """Of points near the surface: no map says anything."""
    places: tuple[WorstPlace, ...] = ()
    """The worst first; at most three."""

    @property
    def wrong_percent(self) -> float:
        return self.false_inside_percent + self.false_outside_percent


def _mesh(vertices: Any, triangles: Any) -> tuple[np.ndarray, np.ndarray]:
    corners = np.asarray(triangles)
    if corners.size and (corners.dtype.kind not in "iu" or corners.min() < 0):
        raise UsageError("triangles are indices of vertices, from 0 up")
    return np.ascontiguousarray(vertices, dtype=np.float32), np.ascontiguousarray(corners, dtype=np.uint32)


def _is_path(mesh: Any) -> bool:
    return isinstance(mesh, (str, os.PathLike))


def bake(mesh: Any, triangles: Any = None, *, budget: int = 1_000_000, quality: str = "normal", max_maps: int = 8,
         thickness: Optional[float] = None, name: str = "mesh") -> Collider:
    """Bakes a mesh, as `relief bake` does by default.

    mesh: a file's path, read in a sandbox of its own; or vertices, (n, 3), with triangles, (m, 3).
    budget: bytes on the GPU. quality: "normal" or "fast". thickness: of the shells that open parts become, in the mesh's
    units; None: by size and budget. name: what the container calls the mesh, if it is no file.
    """
    if quality not in ("normal", "fast"):
        raise UsageError("quality is 'normal' or 'fast'")
    if _is_path(mesh):
        if triangles is not None:
            raise UsageError("a file has its own triangles")
        return Collider(_relief.bake_file(os.fspath(mesh), budget, quality, max_maps, thickness))
    if triangles is None:
        raise UsageError("vertices need triangles")
    return Collider(_relief.bake_mesh(*_mesh(mesh, triangles), name, budget, quality, max_maps, thickness))


def load(source: Union[Path, bytes]) -> Collider:
    """A .relief file, or its bytes."""
    return Collider(_relief.read(source) if isinstance(source, bytes) else _relief.load(os.fspath(source)))


def check(collider: Collider, mesh: Any, triangles: Any = None, *, samples: int = 200_000, seed: int = 1) -> Accuracy:
    """How wrong a collider is, at random points about the mesh: a file, or vertices and triangles."""
    if _is_path(mesh):
        said = _relief.check_file(collider._handle, os.fspath(mesh), samples, seed)
    else:
        said = _relief.check_mesh(collider._handle, *_mesh(mesh, triangles), samples, seed)
    places = tuple(WorstPlace(**place) for place in said.pop("places"))
    return Accuracy(**said, places=places)


class Hits(NamedTuple):
    """n hits: a particle touches a body or the ground, and in the step before it touched nothing."""

    step: np.ndarray
    """(n,) uint64: the step, from 1; it rises."""
    time: np.ndarray
    """(n,) float64: seconds, within the step."""
    id: np.ndarray
    """(n,) uint32: the particle, as in Simulation.ids."""
    type: np.ndarray
    """(n,) uint32"""
    body: np.ndarray
    """(n,) int32: which collider of the scene, from 0; -1: the ground."""
    position: np.ndarray
    """(n, 3) float32: where the surface was touched."""
    normal: np.ndarray
    """(n, 3) float32: of the surface, out of the body."""
    velocity: np.ndarray
    """(n, 3) float32: that the particle came with."""
    speed: np.ndarray
    """(n,) float32: of approach along the normal, relative to the surface."""


class Simulation:
    """A scene of `relief-sim`, without a window. The GPU's context belongs to the thread that makes it."""

    def __init__(self, scene: Path, *, seed: Optional[int] = None, root: Optional[Path] = None,
                 hits: bool = False) -> None:
        """seed: of every emitter, instead of the scene's. root: a folder whose files the scene may name beside those of
        its own. hits: keep them for take_hits(), which costs time in each step."""
        self._handle = _relief.Simulation(os.fspath(scene), seed, os.fspath(root or ""), hits)
        self._read: Optional[dict[str, np.ndarray]] = None

    def step(self, count: int = 1) -> None:
        """So many steps of the scene's length."""
        self._handle.step(count)
        self._read = None

    def take_hits(self) -> Hits:
        """Those of the steps since the last call, in the order of steps; waits for the GPU. Up to 262,144 a step."""
        return Hits(**self._handle.take_hits())

    @property
    def time(self) -> float:
        return self._handle.time

    @property
    def alive(self) -> int:
        return self._handle.alive

    def _state(self, name: str) -> np.ndarray:
        if self._read is None:
            self._read = self._handle.read()
        return self._read[name]

    @property
    def positions(self) -> np.ndarray:
        """(n, 3) float32, in the order of ids(), velocities() and the others. Read back once a step."""
        return self._state("positions")

    @property
    def velocities(self) -> np.ndarray:
        return self._state("velocities")

    @property
    def ids(self) -> np.ndarray:
        """(n,) uint32: births before its own."""
        return self._state("ids")

    @property
    def types(self) -> np.ndarray:
        """(n,) uint32: the numbers of their [[type]]."""
        return self._state("types")

    @property
    def ages(self) -> np.ndarray:
        """(n,) float32: seconds since birth."""
        return self._state("ages")

    @property
    def lifetimes(self) -> np.ndarray:
        """(n,) float32: seconds from birth to death."""
        return self._state("lifetimes")

    @property
    def collisions(self) -> np.ndarray:
        """(n,) uint32: steps in contact so far."""
        return self._state("collisions")
