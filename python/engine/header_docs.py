"""Writes the comments of C++ headers as a C++ header of texts, so that Python shows what the headers say.

    python3 header_docs.py OUTPUT HEADER...

A comment above a declaration (`/// ...`) or behind it (`///< ...`) becomes `sinew::doc::<Struct>_<member>`, or
`sinew::doc::<name>` outside of structs. Of overloads the first with a comment counts. A binding that names something
without a comment does not compile, which is how completeness is kept.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

_OPENS = re.compile(r"^(?:template\s*<[^>]*>\s*)?(struct|class|enum class|enum|namespace)\s+([A-Za-z_][\w:]*)?[^;{]*\{")
_ONE_LINE_ENUM = re.compile(r"^enum class (\w+)\s*\{[^}]*\};")
_NAME = re.compile(r"([A-Za-z_]\w*)\s*(?:=[^,;]*|\{[^}]*\})?\s*[,;]")


def _without_brackets(text: str) -> str:
    """The text without what stands in <...>, (...) and {...}."""
    for pattern in (r"<[^<>]*>", r"\([^()]*\)", r"\{[^{}]*\}"):
        before = ""
        while before != text:
            before, text = text, re.sub(pattern, "", text)
    return text


def _names(declaration: str) -> list[str]:
    """What a declaration declares: a function's name, or those of all its variables."""
    function = re.match(r"[^=;{]*?\b([A-Za-z_]\w*)\s*\(", declaration)
    if function and not re.match(r"\s*(?:std::function|std::variant)", declaration):
        return [function.group(1)]
    return _NAME.findall(_without_brackets(declaration) + ";")


def comments(text: str) -> Iterator[tuple[str, str]]:
    """Name and comment of everything that has one in a header."""
    scope: list[str] = []  # "" for namespaces and functions
    above: list[str] = []
    last: list[str] = []  # what a trailing comment in the next line goes on about
    pending = ""
    found: dict[str, list[str]] = {}
    for raw in text.splitlines():
        line = raw.strip()
        if line.startswith("///<"):
            for name in last:
                found[name].append(line[4:].strip())
            continue
        if line.startswith("///"):
            above.append(line[3:].strip())
            continue
        if line.startswith(("//", "#")) or not line:
            above, last = ([], []) if not line else (above, last)
            continue
        code, _, behind = line.partition("///<")
        code = code.split("//")[0].strip()
        pending = f"{pending} {code}".strip()
        if not re.search(r"[;{}]$", code) and not behind:
            if not code.endswith(":"):
                continue  # the declaration goes on in the next line
        inside = "_".join(part for part in scope if part)
        opens = _OPENS.match(pending)
        one_line = _ONE_LINE_ENUM.match(pending)
        if one_line or opens:
            kind, name = ("enum", one_line.group(1)) if one_line else (opens.group(1), opens.group(2) or "")
            names = [name] if kind != "namespace" else []
        elif pending.startswith("}") or pending.endswith(":"):
            names = []
        elif inside and "enum" in scope:
            names = []
        else:
            names = _names(pending)
        last = []
        for name in names:
            full = f"{inside}_{name}" if inside else name
            said = [behind.strip()] if behind.strip() else above
            if said and full not in found:
                found[full] = list(said)
                if behind.strip():
                    last.append(full)
        for number, character in enumerate(pending):
            if character == "{":
                is_type = opens and not one_line and "{" not in pending[:number] and opens.group(1) in ("struct", "class")
                scope.append(opens.group(2) if is_type and opens else "")
            elif character == "}" and scope:
                scope.pop()
        above, pending = [], ""
    for name, said in found.items():
        yield name, " ".join(said).strip()


def main() -> None:
    output, *headers = sys.argv[1:]
    texts: dict[str, str] = {}
    for header in headers:
        for name, said in comments(Path(header).read_text(encoding="utf-8")):
            texts.setdefault(name, said)
    lines = ["// Made by python/engine/header_docs.py from the comments of the engine's headers.", "#pragma once", ""]
    lines.append("namespace sinew::doc {")
    for name, said in sorted(texts.items()):
        lines.append(f'inline constexpr const char* {name} = R"doc({said})doc";')
    lines.append("}  // namespace sinew::doc")
    Path(output).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
