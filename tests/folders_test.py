#!/usr/bin/env python3
"""Folders include each other in one direction only, and unit tests lie as what they test."""
import os
import pathlib
import re
import subprocess
import sys

LAYERS = ["core", "comm", "tasks", "app"]
root = pathlib.Path(os.environ.get("BARCHAN_SOURCE", pathlib.Path(__file__).parent.parent))


def includes():
    """Of every folder, by the folder that it includes, one include as an example."""
    found = {}
    for layer in LAYERS:
        for path in sorted((root / layer).rglob("*.[hc]pp")):
            folder = path.parent.relative_to(root).as_posix()
            for name in re.findall(r"#include <barchan/([^>]+)>", path.read_text(encoding="utf8")):
                other = os.path.dirname(name)
                if other != folder:
                    found.setdefault(folder, {}).setdefault(other, f"{path.name}: {name}")
    return found


def cycle(edges):
    """Folders of which each includes the next one and the last one the first; empty: there are none."""
    done = set()

    def look(folder, way):
        if folder in way:
            return way[way.index(folder):]
        if folder in done:
            return []
        for other in edges.get(folder, {}):
            if found := look(other, way + [folder]):
                return found
        done.add(folder)
        return []

    for folder in edges:
        if found := look(folder, []):
            return found
    return []


def main():
    edges, complaints = includes(), []
    if ring := cycle(edges):
        complaints.append("folders that include each other in a ring:")
        for folder, other in zip(ring, ring[1:] + ring[:1]):
            complaints.append(f"  {folder} includes {other}: {edges[folder][other]}")
    for test in sorted((root / "tests/unit").rglob("*_test.cpp")):
        folder = test.parent.relative_to(root / "tests/unit")
        if not (root / folder).is_dir():
            complaints.append(f"{test.relative_to(root)}: there is no folder {folder} that it could test")
    # A made-up ring, so that a search that finds nothing is noticed.
    if cycle({"a": {"b": ""}, "b": {"c": ""}, "c": {"b": ""}}) != ["b", "c"]:
        complaints.append("the search for rings overlooks one")
    print("\n".join(complaints), end="\n" if complaints else "")
    return 1 if complaints else 0


sys.exit(main())
