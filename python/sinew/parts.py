"""What the classes of `sinew.scene` have in common: they are plain data that turn into the tree a scene file would be."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, TypeVar

import numpy as np
import numpy.typing as npt

from sinew import _engine
from sinew.mesh import Mesh, is_meshio, own_of

Quantity = float | str
"""A number in SI, or text with a unit: 0.012 or "12 mm"."""
Vector = Sequence[Quantity] | npt.NDArray[Any]
Matrix = Sequence[Vector] | npt.NDArray[Any]
Tree = Mapping[str, Any]
"""A part of a scene as a dict, with the keys of a scene file."""
MeshSource = str | os.PathLike[str] | Mesh
"""A file, looked up from the scene's folder; a `sinew.Mesh`; or a mesh of meshio."""

P = TypeVar("P", bound="Part")


def plain(value: Any) -> Any:
    """Parts, arrays, paths and NumPy's numbers as dicts, lists, strings and Python's."""
    if isinstance(value, Part):
        return value.tree()
    if isinstance(value, Mapping):
        return {str(key): plain(own) for key, own in value.items()}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, str):
        return value
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if is_meshio(value):
        return os.fspath(own_of(value))
    if isinstance(value, Sequence):
        return [plain(own) for own in value]
    return value


class Part:
    """A part of a scene: keyword arguments with the names of the keys of scene files (`in_` and `from_` for `in` and
    `from`). Nothing is judged before `sinew.build`, or `Scene.check`."""

    _kind: ClassVar[str] = ""
    """The key that such a part stands under where several kinds are possible: {slide: {...}}."""

    def tree(self) -> dict[str, Any]:
        """As a scene file would have it, in dicts and lists."""
        assert dataclasses.is_dataclass(self)
        tree: dict[str, Any] = {}
        for own in dataclasses.fields(self):
            value = getattr(self, own.name)
            if value is not None and not own.metadata.get("not_a_key"):
                tree[own.name.rstrip("_")] = plain(value)
        return {self._kind: tree} if self._kind else tree

    @classmethod
    def from_tree(cls: type[P], tree: Tree) -> P:
        """The other way round. Throws TypeError for a key that there is not."""
        if cls._kind and set(tree) == {cls._kind}:
            inner: Tree = tree[cls._kind]
            tree = inner
        known = {own.name.rstrip("_"): own for own in dataclasses.fields(cls)}  # type: ignore[arg-type]
        values: dict[str, Any] = {}
        for key, value in tree.items():
            if key not in known:
                raise TypeError(f"{cls.__name__} has no key {key!r}; known: {', '.join(known)}")
            own = known[key]
            kinds = own.metadata.get("kinds", ())
            if own.metadata.get("named") and isinstance(value, Mapping):
                values[own.name] = {name: _part_of(part, kinds) for name, part in value.items()}
            else:
                values[own.name] = _part_of(value, kinds)
        return cls(**values)


def _part_of(tree: Any, kinds: Sequence[str]) -> Any:
    if isinstance(tree, list):
        return [_part_of(item, kinds) for item in tree]
    if not isinstance(tree, Mapping):
        return tree
    from sinew import scene

    for kind in kinds:
        cls: type[Part] = getattr(scene, kind)
        keys = {own.name.rstrip("_") for own in dataclasses.fields(cls)}  # type: ignore[arg-type]
        if set(tree) == {cls._kind} or (not cls._kind and set(tree) <= keys):
            part: Part = cls.from_tree(dict(tree))
            return part
    return dict(tree)


class SceneMethods(Part):
    """What a scene can do besides being data."""

    folder: str | os.PathLike[str]

    @classmethod
    def from_file(cls: type[P], file: str | os.PathLike[str], changes: Mapping[str, Any] | Sequence[str] = ()) -> P:
        """A scene file (YAML), to be changed and built.

        changes: as `--set` of the program, {"rods.cable.sections": 30}. Throws InputError with file and line."""
        read = cls.from_tree(_engine.read_tree(os.fspath(file), assignments(changes)))
        read.folder = Path(file).parent  # type: ignore[attr-defined]
        return read

    def to_yaml(self) -> str:
        """The scene as text that `sinew run` takes. Meshes given as arrays are named by files that vanish with them."""
        return _engine.write_tree(self.tree())

    def check(self) -> None:
        """Reads the scene without building it. Throws InputError at the first fault."""
        _engine.check_tree(self.tree(), os.fspath(self.folder))


def assignments(changes: Mapping[str, Any] | Sequence[str]) -> list[str]:
    """Changes of a scene as the engine takes them: "path=value", the value in YAML."""
    if isinstance(changes, str):
        return [changes]
    if isinstance(changes, Mapping):
        return [f"{path}={_flow(plain(value))}" for path, value in changes.items()]
    return list(changes)


def _flow(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {_flow(own)}" for key, own in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_flow(own) for own in value) + "]"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value)
