"""Writes python/sinew/scene.py, the classes of scenes, from the program's table of keys:

    build/release/sinew schema | python3 python/make_scene.py > python/sinew/scene.py

A test sees to it that the file is what this makes.
"""

from __future__ import annotations

import json
import keyword
import sys
import textwrap
from typing import Any

Schema = dict[str, Any]

# Structs of the engine whose names say too little, or something else, in Python.
NAMES = {"Holder": "Region", "Parameters": "SolidMaterial", "GivenSection": "StiffnessSection"}
HEAD = '''"""Scenes as Python objects, with the names of scene files. Made by python/make_scene.py from `sinew schema`.

Every class takes keyword arguments, and quantities as numbers in SI or as text with a unit. Where a class is expected, a
dict with the same keys will do.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

from sinew.parts import Matrix, MeshSource, Part, Quantity, SceneMethods, Tree, Vector

__all__ = [
{all}
]
'''


class Classes:
    """What has been found so far: every schema that each class, and each of its keys, has somewhere."""

    def __init__(self) -> None:
        self.found: dict[str, list[Schema]] = {}
        self.kind: dict[str, str] = {}

    def name_of(self, schema: Schema) -> str:
        if schema["title"] == "FileTable" and "columns" in schema["properties"]:
            return "FileTrack"
        return NAMES.get(schema["title"], schema["title"])

    def kinds_of(self, schema: Schema) -> list[tuple[str, Schema]]:
        """Key and schema of what an object may be, if it is one of several kinds."""
        if schema.get("type") == "object" and "properties" in schema and "title" not in schema:
            return list(schema["properties"].items())
        return []

    def find(self, schema: Schema, kind: str = "") -> None:
        """Takes in all classes of a value, the inner ones last."""
        if "title" in schema and "properties" in schema:
            name = self.name_of(schema)
            self.found.setdefault(name, []).append(schema)
            self.kind[name] = kind
        for one in schema.get("anyOf", []):
            self.find(one)
        if "items" in schema:
            self.find(schema["items"])
        kinds = bool(self.kinds_of(schema))
        for key, own in schema.get("properties", {}).items():
            self.find(own, key if kinds else "")
        if isinstance(schema.get("additionalProperties"), dict):
            self.find(schema["additionalProperties"])

    def classes_in(self, schema: Schema) -> list[str]:
        """Names of the classes that a value may be, or hold in a list."""
        if "anyOf" in schema:
            names = [name for one in schema["anyOf"] for name in self.classes_in(one)]
            return list(dict.fromkeys(names))
        if schema.get("type") == "array":
            return self.classes_in(schema["items"])
        if kinds := self.kinds_of(schema):
            return [self.name_of(own) for _, own in kinds]
        if schema.get("type") == "object" and "title" in schema:
            return [self.name_of(schema)]
        return []

    def annotation(self, schema: Schema) -> str:
        """The type of a value."""
        if "anyOf" in schema:
            return _union([self.annotation(one) for one in schema["anyOf"]])
        if "const" in schema:
            const = schema["const"]
            return f"Literal[{const if isinstance(const, bool) else json.dumps(const)}]"
        if "enum" in schema:
            return f"Literal[{', '.join(json.dumps(word) for word in schema['enum'])}]"
        if "$ref" in schema:
            return "Quantity"
        match schema.get("type"):
            case "integer":
                return "int"
            case "boolean":
                return "bool"
            case "string":
                return "str"
            case "array":
                item = self.annotation(schema["items"])
                return {"Quantity": "Vector", "Vector": "Matrix"}.get(item, f"Sequence[{item}]")
            case "object" if kinds := self.kinds_of(schema):
                return _union([*(self.name_of(own) for _, own in kinds), "Tree"])
            case "object" if "title" in schema:
                return f"{self.name_of(schema)} | Tree"
            case "object":
                return f"Mapping[str, {self.annotation(schema['additionalProperties'])}]"
        raise ValueError(f"no type for {schema}")

    def kept(self, schema: Schema, names: list[str]) -> str | None:
        """The type of a collection of named or listed parts, which is empty unless it is given."""
        if not names:
            return None
        if schema.get("type") == "array":
            return f"list[{' | '.join(names)}]"
        if schema.get("type") == "object" and isinstance(schema.get("additionalProperties"), dict):
            return f"dict[str, {' | '.join(names)}]"
        return None

    def text_of(self, name: str) -> str:
        """The class."""
        schemas = self.found[name]
        keys = list(schemas[0]["properties"])
        if any(list(own["properties"]) != keys for own in schemas):
            raise ValueError(f"objects of the name {name} have different keys; give one another name in NAMES")
        required = [key for key in keys if all(key in own.get("required", []) for own in schemas)]
        lines: list[str] = []
        said: list[str] = []
        for key in sorted(keys, key=lambda own: own not in required):
            versions = [own["properties"][key] for own in schemas]
            of_mesh = (name, key) in {("Solid", "mesh"), ("MeshShape", "file")}
            annotation = "MeshSource" if of_mesh else _union([self.annotation(own) for own in versions])
            attribute = key + "_" if keyword.iskeyword(key) else key
            inner = [own.get("additionalProperties", {}) or {} for own in versions]
            names = dict.fromkeys(one for own in [*versions, *inner] for one in self.classes_in(own))
            metadata = [f'"kinds": ({"".join(json.dumps(one) + ", " for one in names)[:-1]})'] if names else []
            if any(inner):
                metadata.append('"named": True')
            extra = f"metadata={{{', '.join(metadata)}}}" if metadata else ""
            kept = self.kept(versions[0], list(names)) if len(versions) == 1 and not of_mesh else None
            if key in required:
                default = f" = field({extra})" if extra else ""
            elif kept:
                annotation = kept
                default = f" = field(default_factory={kept.split('[')[0]}, {extra})"
            else:
                annotation += " | None"
                default = f" = field(default=None, {extra})" if extra else " = None"
            lines.append(f"    {attribute}: {annotation}{default}")
            said.append(f"{attribute}: {_said(versions[0])}")
        base = "SceneMethods" if name == "Scene" else "Part"
        head = ["", "", "@dataclass(kw_only=True)", f"class {name}({base}):"]
        if name == "Scene":
            lines.append('    folder: str | os.PathLike[str] = field(default=".", metadata={"not_a_key": True})')
            said.append("folder: Where files that the scene names are looked for.")
        what = "a whole scene" if name == "Scene" else schemas[0].get("description", schemas[0]["$comment"])
        head += _docstring(_sentence(what), said)
        if self.kind[name]:
            head += ["", f'    _kind: ClassVar[str] = "{self.kind[name]}"']
        return "\n".join([*head, "", *lines]) + "\n"


def _union(types: list[str]) -> str:
    parts = [part for one in types for part in _split(one)]
    return " | ".join(dict.fromkeys(part for part in parts))


def _split(union: str) -> list[str]:
    """The members of a union, brackets kept whole."""
    parts, depth, start = [], 0, 0
    for i, character in enumerate(union):
        depth += (character == "[") - (character == "]")
        if depth == 0 and union[i : i + 3] == " | ":
            parts.append(union[start:i])
            start = i + 3
    return [*parts, union[start:]]


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def _said(schema: Schema) -> str:
    """What a key means, with an example and the default."""
    text = schema["description"]
    if schema.get("examples"):
        text += "; for example " + json.dumps(schema["examples"][0], ensure_ascii=False)
    if "default" in schema and schema["default"] not in ([], {}):
        text += "; if left out " + json.dumps(schema["default"], ensure_ascii=False)
    return _sentence(text)


def _docstring(what: str, said: list[str]) -> list[str]:
    """What the class is, then its keys."""

    def wrapped(text: str, later: str) -> list[str]:
        whole = {"break_long_words": False, "break_on_hyphens": False}
        return textwrap.wrap(text.replace("\\", "\\\\"), 120, initial_indent="    ", subsequent_indent=later, **whole)

    keys = [line for own in said for line in wrapped(own, " " * 8)]
    return [*wrapped('"""' + what, " " * 4), "", *keys, '    """']


def main() -> None:
    classes = Classes()
    classes.find(json.load(sys.stdin))
    names = "\n".join(f'    "{name}",' for name in sorted(classes.found))
    sys.stdout.write(HEAD.replace("{all}", names) + "".join(classes.text_of(name) for name in classes.found))


if __name__ == "__main__":
    main()
