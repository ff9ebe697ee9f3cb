"""Messages say where, in as many components as there are dimensions, and fit the columns that there are."""
import json
import os

from _helper import DECK, edited, expect, finish, fresh, messages, run, write

LATTICE = DECK[DECK.index("[[particles]]"):DECK.index("[[wall]]")]
PAIR = """[[particles]]
kind = "list"
material = "sand"
particle = [
  { position = [1.0, 0.5], radius = 0.04 },
  { position = [1.0, 0.5], radius = 0.04 },
]

"""
HUGE = "id,type,radius,density,x,y,z\n4611686018427387904,1,0.04,1000,1.0,0.5,0\n"


def line_of(text, part):
    return 1 + text[:text.index(part)].count("\n")


def refused(name, text, words, *more, ranks=1):
    write("wrong.toml", text)
    for command in ("check", "run"):
        extra = ["--quiet"] if command == "run" else []
        done = run(command, "wrong.toml", *extra, *more, ranks=ranks)
        said = "".join(messages(done))
        expect(done.returncode == 2, f"{name}: {command}: status {done.returncode}: {done.stderr}")
        for word in words:
            expect(word in said, f"{name}: {command}: no '{word}' in: {said}")


def check_places():
    pair = edited((LATTICE, PAIR))
    first = line_of(pair, "{ position")
    refused("coincident pair", pair,
            [f"wrong.toml:{first + 1}:", "(1, 0.5)", f"(line {first})", "overlaps particle 1"])
    narrow = edited(("hi = [4.0, 1.0]", 'hi = [4.0, 1.0]\nperiodic = ["x"]'), ("hi = [4.0, 1.0]", "hi = [0.12, 1.0]"),
                    ("hi = [4.0, 0.8]", "hi = [0.12, 0.8]"))
    refused("narrow period", narrow, [f"wrong.toml:{line_of(narrow, '[domain]')}:", "along x", "at least"])
    few = edited(("hi = [4.0, 1.0]", "hi = [0.3, 1.0]\nstrip_axis = \"x\""), ("hi = [4.0, 0.8]", "hi = [0.3, 0.8]"))
    write("few.toml", few)
    place = f"few.toml:{line_of(few, '[domain]')}:"
    for done in (run("run", "few.toml", "--quiet", ranks=3), run("check", "few.toml", "--ranks", 3)):
        said = "".join(messages(done))
        expect(done.returncode == 2 and place in said and "3 ranks" in said, f"too many ranks: {said}")
    unstable = edited(("step = 1e-4", "step = 0.05"))
    refused("unstable step", unstable, [f"wrong.toml:{line_of(unstable, 'step = 0.05')}:8:", "use at most"])
    write("huge.csv", HUGE)
    refused("huge id", edited((LATTICE, '[[particles]]\nkind = "file"\npath = "huge.csv"\nmaterial = "sand"\n\n')),
            ["huge.csv:2:", "4611686018427387904 is too large", "4611686018427387903"])


def check_whole_numbers():
    write("whole.toml", edited(("steps = 200", "steps = 2e1")))
    fresh("whole.out")
    for more, steps in (([], 20), (["--steps", "1e1"], 10), (["--set", "time.steps=3e1"], 30)):
        done = run("run", "whole.toml", "--quiet", "--force", *more)
        expect(done.returncode == 0, f"{more}: {done.stderr}")
        with open("whole.out/run.json", encoding="utf-8") as file:
            summary = json.load(file)
        expect(summary["steps"] == steps, f"{more}: {summary['steps']} steps")
        expect("other" not in summary["phases"], f"phases: {summary['phases']}")
        share = sum(summary["phases"].values()) / summary["loop_seconds"]
        expect(abs(share - 1.0) < 1e-3, f"{more}: phases add up to {share} of the loop")
    done = run("run", "whole.toml", "--quiet", "--force", "--steps", "1.5")
    expect(done.returncode == 2 and "not a whole number" in done.stderr, f"1.5 steps: {done}")


def check_columns():
    write("case.toml", DECK)
    for columns in ("60", "100", None):
        os.environ.pop("COLUMNS", None)
        if columns:
            os.environ["COLUMNS"] = columns
        done = run("run", "case.toml", "--force", ranks=2)
        wide = [line for line in done.stdout.splitlines() if len(line) > int(columns or 100)]
        expect(done.returncode == 0 and not wide, f"{columns} columns: {wide} {done.stderr}")
    os.environ.pop("COLUMNS", None)


check_places()
check_whole_numbers()
check_columns()
finish()
