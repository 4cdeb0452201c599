#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the arrows and rules of docs/adr/0001-rooms.md on the sources below a root folder.

usage: include_graph.py ROOT      prints one line per finding; exit status 1 when there is any
"""
import re
import sys
from pathlib import Path

ESTIMATORS = {"core", "association", "cekf", "pf_relocalize", "smoothing", "localization", "fastslam", "relocalize",
              "atlas", "supervisor", "team"}
SEE_MRPT = {"mrpt_adapter", "apps"}
TRUTH = {"helixnav/core/recording.hpp", "helixnav/core/team_recording.hpp"}
FILES_AND_SCREENS = {"iostream", "fstream", "filesystem"}
STANDARD_HEADERS = set("""
    algorithm any array atomic bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes climits clocale cmath
    complex condition_variable csetjmp csignal cstdarg cstddef cstdint cstdio cstdlib cstring ctime cwchar cwctype deque
    exception execution filesystem forward_list fstream functional future initializer_list iomanip ios iosfwd iostream
    istream iterator limits list locale map memory memory_resource mutex new numeric optional ostream queue random ratio
    regex scoped_allocator set shared_mutex sstream stack stdexcept streambuf string string_view system_error thread tuple
    type_traits typeindex typeinfo unordered_map unordered_set utility valarray variant vector""".split())
FORBIDDEN_CALLS = re.compile(
    r"\bstd::(?:cout|cerr|clog|random_device|exit|abort|quick_exit|terminate)\b"
    r"|(?<![\w.>:])(?:printf|puts|exit|abort|assert)\s*\(|\bfprintf\s*\(")

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')
TABLE_ROW = re.compile(r"^\| (\w+)/ \|.*\| ([^|]+) \|$")


def read_table(adr):
    """{room: rooms that it may include}, in the order of the table, where "everything above" means the rows above."""
    table = {}
    for line in adr.read_text(encoding="utf-8").splitlines():
        row = TABLE_ROW.match(line)
        if not row:
            continue
        room, may = row.group(1), row.group(2).strip()
        if may == "-":
            table[room] = set()
        elif may == "everything above":
            table[room] = set(table)
        else:
            table[room] = {name.strip() for name in may.split(",")}
    if not table:
        raise SystemExit(f"{adr}: no table of rooms")
    for room, may in table.items():
        above = set(list(table)[: list(table).index(room)])
        # Every arrow points up the table, so the rooms that are allowed cannot form a cycle.
        if not may <= above:
            raise SystemExit(f"{adr}: {room} may include {sorted(may - above)}, which does not stand above it")
    return table


def without_comments_and_strings(text):
    """The same text with comments and literals blanked, line numbers kept."""
    token = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL)
    return token.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def check_include(room, path, source_root, quote, target, table):
    """What is wrong with one #include, or None. source_root is None for public headers, else the room's src folder."""
    is_public = source_root is None
    parts = target.split("/")
    if parts[0] == "helixnav":
        other = parts[1] if len(parts) > 2 else None
        if other not in table:
            return f"{target} is in no room"
        if other != room and other not in table[room]:
            return f"{room} must not include {other} ({target})"
        if target in TRUTH and room in ESTIMATORS and path.stem not in {"recording", "team_recording"}:
            return f"estimators do not see truth ({target})"
        return None
    if parts[0] == "mrpt" and room not in SEE_MRPT:
        return f"MRPT appears in mrpt_adapter and apps only ({target})"
    if quote == '"':
        if ".." in parts or is_public:
            return f'say "helixnav/<room>/…" instead of {target}'
        room_root = source_root.parent
        above = [folder for folder in path.parents if folder.is_relative_to(room_root)]
        return None if any((folder / target).is_file() for folder in [source_root, *above]) else f"{target} is no header of {room}/src; what is not ours goes into <>"
    if room in ESTIMATORS and target in FILES_AND_SCREENS:
        return f"estimators see no files and no screens (<{target}>)"
    if is_public and room != "mrpt_adapter" and parts[0] != "Eigen" and target not in STANDARD_HEADERS:
        return f"public headers include Eigen, the standard library and ours only (<{target}>)"
    return None


def check_file(room, path, source_root, table):
    """Yields (line, finding) of one source or header."""
    is_public = source_root is None
    text = path.read_text(encoding="utf-8")
    code = without_comments_and_strings(text).splitlines()
    for number, (line, bare) in enumerate(zip(text.splitlines(), code), start=1):
        include = INCLUDE.match(line) if bare.lstrip().startswith("#") else None
        if include:
            finding = check_include(room, path, source_root, include.group(1), include.group(2), table)
            if finding:
                yield number, finding
        if is_public and re.match(r"\s*#\s*define\b", bare):
            yield number, "no macros in public headers"
        call = FORBIDDEN_CALLS.search(bare) if room != "apps" else None
        if call:
            yield number, f"libraries do not print, exit, abort, assert or draw seeds ({call.group().strip()})"


def check(root):
    """All findings below root as lines "file:line: what"."""
    table = read_table(root / "docs/adr/0001-rooms.md")
    findings = []
    for room in table:
        for path in sorted([*root.glob(f"{room}/**/*.hpp"), *root.glob(f"{room}/**/*.cpp")]):
            place = path.relative_to(root)
            if "node_modules" in place.parts:
                continue
            is_public = place.parts[1] == "include"
            if is_public and place.parts[:4] != (room, "include", "helixnav", room):
                findings.append(f"{place}:1: public headers live in {room}/include/helixnav/{room}/")
            source_root = None if is_public else root / room / "src"
            findings += [f"{place}:{line}: {finding}" for line, finding in check_file(room, path, source_root, table)]
    return findings


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    found = check(Path(sys.argv[1]))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)
