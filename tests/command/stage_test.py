"""A run ends with its last stage where that comes before its last step: at the same step, with the same bits, however it runs."""
import csv
import json

from _faults import CHECKPOINTS, log_of
from _helper import DECK, expect, finish, fresh, run, timed, write

STAGES = '\n[[stage]]\nname = "settle"\nmax_time = 5.5e-3\n\n[[stage]]\nname = "rest"\n'
OUT = "stage.out"


def ended_at(name, *arguments, ranks=1):
    """@return the step and the digest"""
    done = run("run", "stage.toml", "--out", OUT, "--quiet", *arguments, ranks=ranks)
    expect(done.returncode == 0, f"{name}: {done.stderr}")
    with open(OUT + "/run.json", encoding="utf-8") as file:
        numbers = json.load(file)
    expect(not numbers["interrupted"], f"{name}: interrupted")
    with open(OUT + "/series.csv", encoding="utf-8") as file:
        last = list(csv.DictReader(file))[-1]
    expect(int(last["step"]) == numbers["steps"], f"{name}: the last row is of step {last['step']}")
    return numbers["steps"], numbers["state_digest"]


def check_time():
    write("stage.toml", DECK + CHECKPOINTS + STAGES + "max_time = 4e-3\n")
    fresh(OUT)
    done = run("check", "stage.toml")
    expect("Run: at most 0.0095 s in steps of 0.0001 s" in done.stdout, f"check of a short last stage: {done.stdout}")
    expected = ended_at("one rank")
    expect(expected[0] == 95, f"ended at step {expected[0]}, not 55 + 40")
    expect("'rest', is over" in log_of(OUT), f"log: {log_of(OUT)}")
    for ranks, more in ((2, ("--threads", "1")), (1, ("--threads", "2")), (2, ("--schedule", "sequential", "--exchange", "isend"))):
        expect(ended_at(f"{ranks} ranks, {more}", *more, "--force", ranks=ranks) == expected, f"{ranks} ranks, {more}")
    expect(ended_at("as many steps", "--steps", "95", "--force") == expected, "with as many steps")
    expect(ended_at("a restart at the end", "--restart", "auto") == expected, "a restart at the end")
    ended_at("cut short", "--steps", "70", "--force")
    expect(ended_at("a restart before the end", "--restart", "auto", ranks=2) == expected, "a restart before the end")
    longer = ended_at("a longer last stage", "--restart", "auto", "--set", "stage.rest.max_time=8e-3")
    expect(longer[0] == 135, f"a longer last stage ended at step {longer[0]}")
    expect(longer == ended_at("in one go", "--force", "--set", "stage.rest.max_time=8e-3"), "a longer last stage: another digest")
    expect(ended_at("fewer steps than stages", "--force", "--steps", "60")[0] == 60, "fewer steps than stages")


def check_ratio():
    write("stage.toml", DECK + '\n[[stage]]\nname = "settle"\nlocal_damping = 0.8\nkinetic_ratio = 1e-2\n')
    fresh(OUT)
    expected = ended_at("by ratio", "--steps", "100000")
    expect(0 < expected[0] < 100000 and expected[0] % 100 == 0, f"by ratio: ended at {expected}")
    expect(ended_at("by ratio, 2 ranks", "--steps", "100000", "--force", ranks=2) == expected, "by ratio, 2 ranks")


timed(check_time)
timed(check_ratio)
finish()
