"""Messages say where, in as many components as there are dimensions, and fit the columns that there are."""
import fcntl
import json
import os
import pty
import re
import struct
import subprocess
import termios

from _helper import DECK, command_line, edited, expect, finish, fresh, messages, run, write

LATTICE = DECK[DECK.index("[[particles]]"):DECK.index("[[wall]]")]
PAIR = """[[particles]]
kind = "list"
material = "sand"
particle = [
  { position = [1.0, 0.5], radius = 0.04 },
  { position = [1.0, 0.5], radius = 0.04 },
]

"""
FILE = '[[particles]]\nkind = "file"\npath = "PATH"\nmaterial = "sand"\n\n'
ROWS = "id,type,radius,density,x,y,z\n1,1,0.04,1000,1.0,0.5,0\n2,1,0.04,1000,1.0,0.5,0\n"
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
    write("pair.csv", ROWS)
    of_file = FILE.replace("PATH", "pair.csv")
    refused("coincident pair of a file", edited((LATTICE, of_file)), ["pair.csv:3:", "overlaps", "(line 2)"])
    both = edited((LATTICE, PAIR.replace("[1.0, 0.5], radius = 0.04 },\n]", "[2.0, 0.5], radius = 0.04 },\n]") + of_file))
    write("pair.csv", ROWS.replace("2,1,0.04,1000,1.0", "4,1,0.04,1000,3.0").replace("\n1,", "\n3,"))
    refused("pair of a file and a list", both, ["pair.csv:2: particle 3", f"(wrong.toml:{line_of(both, '{ position')})"])
    narrow = edited(("hi = [4.0, 1.0]", 'hi = [4.0, 1.0]\nperiodic = ["x"]'), ("hi = [4.0, 1.0]", "hi = [0.12, 1.0]"),
                    ("hi = [4.0, 0.8]", "hi = [0.12, 0.8]"))
    refused("narrow period", narrow, [f"wrong.toml:{line_of(narrow, '[domain]')}:", "along x", "at least"])
    few = edited(("hi = [4.0, 1.0]", 'hi = [0.3, 1.0]\nstrip_axis = "x"\ncuts = "strips"'), ("hi = [4.0, 0.8]", "hi = [0.3, 0.8]"))
    write("few.toml", few)
    place = f"few.toml:{line_of(few, 'cuts')}:"
    for done in (run("run", "few.toml", "--quiet", ranks=3), run("check", "few.toml", "--ranks", 3)):
        said = "".join(messages(done))
        expect(done.returncode == 2 and place in said and "3 ranks" in said, f"too many ranks: {said}")
    unstable = edited(("step = 1e-4", "step = 0.05"))
    refused("unstable step", unstable, [f"wrong.toml:{line_of(unstable, 'step = 0.05')}:8:", "use at most"])
    write("huge.csv", HUGE)
    huge = edited((LATTICE, FILE.replace("PATH", "huge.csv")))
    refused("huge id", huge, ["huge.csv:2:", "4611686018427387904 is too large", "4611686018427387903"])
    write("huge.csv", HUGE.replace("4611686018427387904", "99999999999999999999"))
    refused("id of 20 digits", huge, ["huge.csv:2:", "99999999999999999999", "4611686018427387903"])


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
    for option, word, said in (("--steps", "1.5", "'1.5' is not a whole number"), ("--steps", "ten", "'ten' is not a whole number"),
                               ("--steps", "1e30", "1e30 is too large"), ("--threads", "1.5", "'1.5' is not a whole number")):
        done = run("run", "whole.toml", "--quiet", "--force", option, word)
        expect(done.returncode == 2 and f"{option}: {said}" in done.stderr, f"{option} {word}: {done}")
    done = run("check", "whole.toml", "--ranks", "2e0")
    expect(done.returncode == 0 and "\n  2      " in done.stdout, f"2e0 ranks: {done}")


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


def check_terminal():
    """Progress on a terminal stays on one line, whatever its width."""
    write("long.toml", edited(("steps = 200", "steps = 60000"), ("step = 1e-4", "step = 1e-6")))
    for columns in (36, 90):
        shown, terminal = pty.openpty()
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        done = subprocess.Popen(command_line(["run", "long.toml", "--force"], 1), stdout=terminal, stderr=terminal)
        os.close(terminal)
        text = b""
        try:
            while piece := os.read(shown, 65536):
                text += piece
        except OSError:  # Linux ends a terminal that nobody writes to this way
            pass
        os.close(shown)
        lines = re.split(r"\r\x1b\[K|\r?\n", text.decode())
        progress = [line for line in lines if line.startswith("step ")]
        wide = [line for line in lines if len(line) > columns and " " in line.strip()]
        expect(done.wait() == 0 and progress and not wide, f"{columns} columns: {wide} of {lines}")
        expect(all(len(line) < columns for line in progress), f"{columns} columns: {progress}")
        expect(("particle-steps/s" in "".join(progress)) == (columns == 90), f"{columns} columns: {progress}")


check_places()
check_whole_numbers()
check_columns()
check_terminal()
finish()
