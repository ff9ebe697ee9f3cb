"""docs/tutorial.md, typed as it stands: its files are saved, its commands run, in order, and its statements hold.

A block of TOML is saved under, or added to, the file that the line before it names. Of the set-up (the first block) only the
last line is run, since a build is there.
"""
import csv
import json
import os
import re
import subprocess

from _helper import COMMAND, SECONDS, expect, finish, fresh
from work_folder import SOURCE

HOME = os.path.abspath("home")
FILE = re.compile(r"(Save this as|Add this to the end of) `([\w.]+)`:$")


def blocks():
    """[(paragraph before, language, text)]"""
    with open(SOURCE / "docs" / "tutorial.md", encoding="utf-8") as file:
        parts = re.split(r"^```", file.read(), flags=re.MULTILINE)
    return [(before.strip(), *block.split("\n", 1)) for before, block in zip(parts[::2], parts[1::2])]


def script():
    """The whole tutorial for a shell that stops where a command fails."""
    setup, *rest = blocks()
    expect("./quickstart build" in setup[2], "the first block no longer builds the command")
    lines = ["set -e", f"cd '{SOURCE}'", setup[2].splitlines()[-1], f"PATH='{os.path.dirname(COMMAND)}':$PATH"]
    for before, language, text in rest:
        if language == "sh":
            lines.append(text)
            continue
        found = FILE.search(before)
        expect(found is not None, f"no file is named before the block after '{before[-80:]}'")
        redirection = ">" if found.group(1).startswith("Save") else ">>"
        lines.append(f"cat {redirection} {found.group(2)} << 'END_OF_FILE'\n{text}END_OF_FILE")
    return "\n".join(lines)


def result(out):
    with open(f"{HOME}/soil/{out}/run.json", encoding="utf-8") as file:
        return json.load(file)


def force_on(out, wall):
    return next(w["force"] for w in result(out)["walls"] if w["name"] == wall)


def check_statements(printed):
    for words in ("596 disks", "did you mean 'friction'?", "exit status 2", "within a fifth of every limit"):
        expect(words in printed, f"the tutorial's commands do not print '{words}'")
    expect(result("box.out")["state_digest"] == result("two_ranks.out")["state_digest"], "two ranks, another digest")
    expect(result("loaded.out")["state_digest"] == result("parts.out")["state_digest"], "in parts, another digest")
    down = -sum(force_on("box.out", wall)[1] for wall in ("floor", "left", "right"))
    expect(abs(down - 23_500) < 200, f"the walls bear {down} N of a weight of 23.5 kN")
    expect(abs(force_on("box.out", "floor")[1] + 22_000) < 1000, "the floor does not bear about 22 kN")
    for out, load in (("loaded.out", 12_000), ("load_10000.out", 6_000), ("load_40000.out", 24_000)):
        up = force_on(out, "plate")[1]
        expect(abs(up / load - 1) < 0.05, f"{out}: the plate bears {up} N, not {load} N")
    with open(f"{HOME}/soil/loaded.out/series.csv", encoding="utf-8") as file:
        heights = [float(row["plate_position_y"]) for row in csv.DictReader(file)]
    expect(abs(heights[0] - heights[-1] - 0.08) < 0.02, f"the plate sinks from {heights[0]} to {heights[-1]}")
    for name in ("box.out/picture.png", "loaded.out/picture.png", "plate.svg", "forces.svg"):
        expect(os.path.getsize(f"{HOME}/soil/{name}") > 1000, f"{name} is empty")


fresh(HOME)
os.mkdir(HOME)
done = subprocess.run(["bash", "-c", script()], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                      timeout=SECONDS, env={**os.environ, "HOME": HOME})
expect(done.returncode == 0, f"the tutorial ends with status {done.returncode}:\n{done.stdout}")
if done.returncode == 0:
    check_statements(done.stdout)
finish()
