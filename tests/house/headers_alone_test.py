"""headers_alone_test.py SOURCE_DIR COMPILE_COMMANDS ROOM...: every public header of the rooms has a compiler call of its own.

A unity build may put the generated sources of several headers into one; a header that forgot an include then passes.
"""
import json
import pathlib
import sys


def public_headers(source, rooms):
    for room in rooms:
        include = source / room / "include"
        for header in sorted(include.rglob("*.hpp")):
            yield header.relative_to(include)


def main():
    source = pathlib.Path(sys.argv[1])
    compiled = [call["file"] for call in json.loads(pathlib.Path(sys.argv[2]).read_text())]
    alone = {file.split("/alone/", 1)[1] for file in compiled if "/alone/" in file}
    headers = list(public_headers(source, sys.argv[3:]))
    missing = [header for header in headers if str(header.with_suffix(".cpp")) not in alone]
    for header in missing:
        print(f"{header} is not compiled alone")
    if not headers:
        print("no public headers found")
    return 1 if missing or not headers else 0


sys.exit(main())
