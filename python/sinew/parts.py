"""What the classes of `sinew.scene` have in common: they are plain data that turn into the tree a scene file would be."""

from __future__ import annotations

import dataclasses
import difflib
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, TypeVar

import numpy as np
import numpy.typing as npt

from sinew import _engine
from sinew.errors import InputError
from sinew.mesh import Mesh, is_meshio

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
    """Parts, arrays, paths and NumPy's numbers as dicts, lists, strings and Python's; meshes by their names."""
    return _plain(value, {})


def _plain(value: Any, meshes: dict[str, bytes]) -> Any:
    """Takes in the meshes that it meets."""
    if isinstance(value, Part):
        return value._tree(meshes)
    if isinstance(value, Mapping):
        return {str(key): _plain(own, meshes) for key, own in value.items()}
    if is_meshio(value):
        value = Mesh.from_meshio(value)
    if isinstance(value, Mesh):
        meshes[value._name] = value._content
        return value._name
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, str):
        return value
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Sequence) and not isinstance(value, bytes):
        return [_plain(own, meshes) for own in value]
    return value


class Part:
    """A part of a scene: keyword arguments with the names of the keys of scene files (`in_` and `from_` for `in` and
    `from`). Nothing is judged before `sinew.build`, or `Scene.check`."""

    _kind: ClassVar[str] = ""
    """The key that such a part stands under where several kinds are possible: {slide: {...}}."""

    def tree(self) -> dict[str, Any]:
        """As a scene file would have it, in dicts and lists."""
        return self._tree({})

    def __setattr__(self, name: str, value: Any) -> None:
        known = [own.name for own in dataclasses.fields(self)]  # type: ignore[arg-type]
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            hint = f"; did you mean `{near[0]}`?" if near else f"; known: {', '.join(known)}"
            raise AttributeError(f"{type(self).__name__} has no key {name!r}{hint}")
        object.__setattr__(self, name, value)

    def _tree(self, meshes: dict[str, bytes]) -> dict[str, Any]:
        assert dataclasses.is_dataclass(self)
        tree: dict[str, Any] = {}
        for own in dataclasses.fields(self):
            value = getattr(self, own.name)
            left_out = value is None or (own.default_factory is not dataclasses.MISSING and not value)
            if not left_out and not own.metadata.get("not_a_key"):
                tree[own.name.rstrip("_")] = _plain(value, meshes)
        return {self._kind: tree} if self._kind else tree

    @classmethod
    def from_tree(cls: type[P], tree: Tree) -> P:
        """The other way round. Throws InputError for a key that there is not."""
        if cls._kind and set(tree) == {cls._kind}:
            inner: Tree = tree[cls._kind]
            tree = inner
        known = {own.name.rstrip("_"): own for own in dataclasses.fields(cls)}  # type: ignore[arg-type]
        values: dict[str, Any] = {}
        for key, value in tree.items():
            if key not in known:
                near = difflib.get_close_matches(key, known, 1)
                rule = f"{cls.__name__} has no such key"
                remedy = (f"did you mean `{near[0]}`? " if near else "") + f"known: {', '.join(known)}"
                raise InputError(f"{key}: {rule}\n    {remedy}", path=key, rule=rule, remedy=remedy)
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
        read.folder = Path(file).parent
        return read

    def to_yaml(self) -> str:
        """The scene as text that `sinew run` takes. It names files; meshes given as arrays `save` puts beside it."""
        return _engine.write_tree(self.tree())

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the scene as a file that `sinew run` takes, and meshes given as arrays beside it. Other files that it
        names are looked for from the folder of the file."""
        meshes: dict[str, bytes] = {}
        text = _engine.write_tree(self._tree(meshes))
        path = Path(file)
        path.write_text(text, encoding="utf-8")
        for name, content in meshes.items():
            (path.parent / name).write_bytes(content)

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
