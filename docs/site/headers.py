"""Pages of the C++ API from the headers of a folder: what they declare for others, with the comments above it as text."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator
from pathlib import Path

_NAMESPACE = re.compile(r"(inline )?namespace [\w:]+ ?\{$|\}  // namespace|using namespace")
_UNNAMED = re.compile(r"^namespace \{.*?^\}  // namespace$", re.DOTALL | re.MULTILINE)
_TYPE = re.compile(r"(?:template\s*<.*?>\s*)?(?:struct|class|enum class|enum|concept|using)\s+(?:\[\[.*?\]\]\s*)?(\w+)", re.DOTALL)
_FUNCTION = re.compile(r"(operator\W{1,2}|~?\w+)\s*\(")
_VALUE = re.compile(r"(\w+)(?:\[[^\]]*\])*\s*(?:=|\{|;)")


def declarations(text: str) -> Iterator[tuple[list[str], list[str]]]:
    """Comment and code, line by line, of all that stands in the namespaces of a header."""
    comment: list[str] = []
    code: list[str] = []
    depth = 0
    text = _UNNAMED.sub("", text)  # what belongs to the file that includes it
    for line in re.sub(r"^[ \t]*#(.*\\\n)*.*$", "", text, flags=re.MULTILINE).splitlines():
        bare = re.sub(r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])'|//.*", "", line).rstrip()
        if depth == 0 and not code:
            if not line.strip():
                comment = []
                continue
            if line.startswith("//"):
                comment.append(line.lstrip("/").removeprefix(" "))
                continue
            if _NAMESPACE.match(line):
                continue
        code.append(line)
        depth += sum(bare.count(c) for c in "{([") - sum(bare.count(c) for c in "})]")
        if depth == 0 and bare.endswith((";", "}")):
            yield comment, code
            comment, code = [], []


def for_others(code: list[str]) -> str:
    """Code without what is private, and without the bodies of functions."""
    text = re.sub(r"\n private:\n.*?(?=\n(?: public:|\};))", "", "\n".join(code), flags=re.DOTALL)
    if _TYPE.match(text):
        return text
    head = re.match(r"([^{=]*\))( const| noexcept)*\s*(:[^:].*?)?\s*\{.*\}$", text, re.DOTALL)
    return f"{head.group(1)}{head.group(2) or ''};" if head else text


def name(code: str) -> str:
    """What a declaration declares."""
    for pattern in (_TYPE, _FUNCTION, _VALUE):
        found = pattern.match(code) if pattern is _TYPE else pattern.search(code)
        if found:
            return found.group(1)
    raise ValueError(f"no name in: {code}")


def prose(lines: list[str]) -> str:
    """A comment as Markdown: text as it is, indented lines as blocks of code."""
    parts = []
    for line in lines:
        if line.startswith("    "):
            parts.append(line)
        else:
            pieces = line.strip().split("`")
            pieces[::2] = [re.sub(r"([\\*_\[\]#])", r"\\\1", html.escape(piece, quote=False)) for piece in pieces[::2]]
            parts.append("`".join(pieces))
    return "\n".join(parts)


def page(folder: Path) -> str:
    """The page of a folder of src/sinew."""
    parts = [f"# {folder.name}", f"What it is and the maths: [{folder.name}/README.md](../../../src/sinew/{folder.name}/README.md)."]
    for header in sorted(folder.glob("*.hpp")):
        text = header.read_text(encoding="utf-8")
        about, rest = re.match(r"((?://[^\n]*\n)*)(.*)", text, re.DOTALL).groups()  # type: ignore[union-attr]
        parts += [f"## {folder.name}/{header.name}", prose([line.removeprefix("//").removeprefix(" ") for line in about.splitlines()])]
        last = None
        for comment, lines in declarations(rest):
            code = for_others(lines)
            if re.fullmatch(r"(struct|class|extern template) .*;", code):  # told where it is defined
                continue
            if name(code) != last:
                last = name(code)
                parts.append(f"### `{last}`")
            parts += [prose(comment), f"```cpp\n{code}\n```"]
    return "\n\n".join(part for part in parts if part) + "\n"
