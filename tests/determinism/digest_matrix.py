"""The state digest of example decks after 1,200 steps, over every way to run them.

usage: digest_matrix.py BARCHAN [--full] [--list]

Every run must end with the digest of one rank, one thread and scalar code; so must runs with other skins. Without --full a choice of runs is made in
which every value of every option occurs, and every exchange on every number of ranks; with it, the whole matrix is run.
All-pairs search is quadratic, so it is compared after fewer steps.
"""

import argparse
import itertools
import json
import os
import pathlib
import re
import subprocess
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from work_folder import SOURCE, leave_tree  # noqa: E402

RANKS = (1, 2, 3, 4)
THREADS = (1, 2)
SCHEDULES = ("overlap", "sequential")
STEPS, ALL_PAIRS_STEPS = 1200, 40

# The plate comes down after a tenth of a second, so that the bonds are loaded within the 1,200 steps.
DECKS = {
    "soil_duct": ["--set", "stage.settle.max_time=0.1", "--set", "wall.plate.point=[8.0, 3.05]"],
    "column_collapse": [],
    "glass_beads": [],
}
FURTHER = ("heap", "wet_column", "powder", "hot_plate")  # other laws, with --full; tests/mpi has each in every way
SKINS = {"soil_duct": (0.02, 0.05), "column_collapse": (0.02, 0.05), "glass_beads": (0.0003, 0.001)}  # nobody's bit


def choices_of(command, option):
    """What the command's help says the option takes."""
    text = subprocess.run([command, "run", "--help"], capture_output=True, text=True, check=True).stdout
    found = re.search(rf"--{option} TEXT:{{([^}}]*)}}", text) or re.search(rf"--{option} NAME[^:]*: ([a-z, -]*), or ", text)
    if not found:
        sys.exit(f"'{command} run --help' does not list the choices of --{option}")
    return [name.strip() for name in found.group(1).split(",")]


def has_width(command, width):
    """Whether this machine has the vector width: asked with a deck of two particles."""
    deck = SOURCE / "examples" / "two_particles.toml"
    run = subprocess.run([command, "run", str(deck), "--steps", "1", "--vector", width, "--out", f"width_{width}",
                          "--force", "--quiet"], capture_output=True, text=True)
    return run.returncode == 0


def digest_of(command, deck, run, folder):
    """Runs a deck one way. @return its digest, or the text of the failure"""
    ranks, threads, exchange, schedule, search, width, *more = run
    steps = ALL_PAIRS_STEPS if search == "all-pairs" else STEPS
    line = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    line += [command, "run", str(SOURCE / "examples" / f"{deck}.toml"), *DECKS.get(deck, []), "--set", "output.picture=false",
             "--steps", str(steps), "--threads", str(threads), "--exchange", exchange, "--schedule", schedule,
             "--contact-search", search, "--vector", width, "--out", folder, "--force", "--quiet", *more]
    try:
        done = subprocess.run(line, capture_output=True, text=True, timeout=300)
    except subprocess.TimeoutExpired:
        return "does not end"
    if done.returncode != 0:
        return f"status {done.returncode}: {done.stderr.strip()[:300]}"
    with open(pathlib.Path(folder) / "run.json", encoding="utf-8") as file:
        return json.load(file)["state_digest"]


def full_matrix(exchanges, widths):
    for ranks, threads, schedule, search, width in itertools.product(RANKS, THREADS, SCHEDULES, ("cells", "all-pairs"),
                                                                     widths):
        for exchange in exchanges if ranks > 1 else exchanges[:1]:
            yield ranks, threads, exchange, schedule, search, width


def chosen(exchanges, widths, shift, skins):
    """Every exchange on every number of ranks, the rest in turns."""
    runs = [(1, 2, exchanges[0], "overlap", "cells", widths[-1]), (1, 1, exchanges[0], "sequential", "all-pairs", widths[-1])]
    ranks = itertools.cycle(RANKS[1:])
    for number, exchange in enumerate(exchanges):
        turn = number + shift
        runs.append((next(ranks), THREADS[turn % 2], exchange, SCHEDULES[turn // 2 % 2], "cells", widths[turn % len(widths)]))
        if number % 3 == shift % 3:
            runs.append((next(ranks), THREADS[turn % 2], exchange, SCHEDULES[turn % 2], "all-pairs", widths[turn % len(widths)]))
    for number, skin in enumerate(skins):
        runs.append((number + 1, 1, exchanges[shift], "overlap", "cells", widths[-1], "--set", f"search.skin={skin}"))
    return runs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("--full", action="store_true", help="the whole matrix: hours on a small machine")
    parser.add_argument("--list", action="store_true", help="only say what would be run")
    options = parser.parse_args()
    options.command = os.path.abspath(options.command)
    leave_tree("digest_matrix")
    exchanges = choices_of(options.command, "exchange")
    exchanges = [name for name in exchanges if name not in ("auto", "replay")]
    widths = [w for w in choices_of(options.command, "vector") if w != "auto" and has_width(options.command, w)]

    failed = number = 0
    begin = time.monotonic()
    for shift, deck in enumerate((*DECKS, *FURTHER) if options.full else DECKS):
        runs = list(full_matrix(exchanges, widths)) if options.full else chosen(exchanges, widths, shift, SKINS[deck])
        if options.list:
            print("\n".join(f"{deck}: {' '.join(map(str, run))}" for run in runs))
            continue
        expected = {}
        for search in ("cells", "all-pairs"):
            reference = (1, 1, exchanges[0], "overlap", "cells" if search == "cells" else "all-pairs", "scalar")
            expected[search] = digest_of(options.command, deck, reference, f"{deck}_{search}")
            print(f"{deck}: {expected[search]} with {search}, one rank, one thread", flush=True)
            if not re.fullmatch(r"[0-9a-f]{16}", expected[search]):
                sys.exit(f"{deck} cannot be run at all")
        for run in runs:
            number += 1
            digest = digest_of(options.command, deck, run, "variant")
            if digest != expected[run[4]]:
                failed += 1
                print(f"{deck}: {digest} with {' '.join(map(str, run))}", flush=True)
    print(f"{number} runs in {time.monotonic() - begin:.0f} s, {failed} differ")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
