#!/usr/bin/python3
"""local_names.py ROOT: names in anonymous namespaces differ within host, within sim, and within a folder of tests, so
that their sources compile together (cmake/modules/AxisUnity.cmake). Reads what clang-format has laid out: declarations
of a namespace start their lines."""

import re
import sys
from collections import defaultdict
from pathlib import Path

DECLARATIONS = [
    r"(?:struct|class|enum(?: class)?) (?:\[\[\w+\]\] )?(\w+)",
    r"(?:constexpr|const|inline|static)[\w:<>,*& ]*? (\w+)(?:\[\w*\])? ?[={]",
    r"[\w:<>,*&][\w:<>,*& ]*[ *&](\w+)\(([^)]*)",
]
NO_NAME = {"if", "for", "while", "switch", "return", "operator", "TEST", "TEST_F"}


def local_names(text: str) -> set[tuple[str, ...]]:
    """Functions with their first line of parameters: overloads may share a name."""
    names: set[tuple[str, ...]] = set()
    is_local = False
    opened = 0
    for number, line in enumerate(text.splitlines()):
        line = re.sub(r"^\[\[\w+\]\] ", "", line)
        if line == "namespace {":
            is_local, opened = True, number
        elif line.startswith("}  // namespace") or line == "}" and number <= opened + 2:
            is_local = False
        if not is_local or not re.match(r"[a-zA-Z]", line) or re.match(r"(struct|class) \w+;", line):
            continue
        for pattern in DECLARATIONS:
            found = re.match(pattern, line)
            if found and found.group(1) not in NO_NAME:
                names.add(found.groups())
                break
    return names


def is_apart(source: Path, root: Path) -> bool:
    """Whether the build file leaves it out of what is compiled together."""
    build = root / source.relative_to(root).parts[0] / "CMakeLists.txt"
    listed = re.findall(r"^set_source_files_properties\(([^)]*?) PROPERTIES SKIP_UNITY_BUILD_INCLUSION", build.read_text(), re.M)
    return any(source.relative_to(build.parent).as_posix() in files.split() for files in listed)


def main(root: Path) -> int:
    bad = 0
    folders: dict[Path, list[Path]] = defaultdict(list)
    for top in ("host", "sim", "tests"):
        for source in sorted((root / top).rglob("*_test.cpp" if top == "tests" else "*.cpp")):
            if "examples" not in source.parts and not is_apart(source, root):
                folders[source.parent if top == "tests" else root / top].append(source)
    for sources in folders.values():
        where: dict[tuple[str, ...], Path] = {}
        for source in sources:
            for name in sorted(local_names(source.read_text(encoding="utf-8"))):
                if name in where:
                    bad += 1
                    print(f"{source.relative_to(root)}: {name[0]} is in {where[name].relative_to(root)} too; rename one", file=sys.stderr)
                where.setdefault(name, source)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
