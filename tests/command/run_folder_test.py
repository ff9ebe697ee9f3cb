"""A run leaves a whole folder behind: after its last step, and when a signal ends it."""
import csv
import json
import os
import signal
import time

from _helper import DECK, SECONDS, edited, expect, finish, fresh, run, start, write
from processes import children_of, rank_of

FIELDS = ["version", "deck", "ranks", "threads", "exchange", "schedule", "contact_search", "transport", "particles",
          "steps", "dt", "time", "loop_seconds", "particle_steps_per_second", "contacts", "rebuilds", "migrations",
          "memory_bytes_per_particle", "phases", "communication", "energy", "state_digest"]
COLUMNS = ["step", "time", "kinetic_energy", "contacts", "max_overlap"]
RING = """
[[bond]]
name = "glue"
young_modulus = 1e5

[[particles]]
kind = "ring"
center = [2.0, 0.5]
radius = 0.25
count = 12
material = "sand"
bond = "glue"
"""


def numbers_of(folder):
    with open(folder + "/run.json", encoding="utf-8") as file:
        return json.load(file)


def rows_of(folder):
    with open(folder + "/series.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def check_whole(folder, ranks, last_step):
    """@param last_step  none where a signal decides"""
    numbers = numbers_of(folder)
    for field in FIELDS:
        expect(field in numbers, f"{folder}: run.json lacks {field}")
    for field in ("in_flight_seconds", "exposed_seconds", "hidden_fraction", "messages", "bytes"):
        expect(field in numbers["communication"], f"{folder}: communication lacks {field}")
    expect({"kinetic", "potential"} <= set(numbers["energy"]), f"{folder}: energy lacks a part")
    digest = numbers["state_digest"]
    expect(len(digest) == 16 and int(digest, 16) >= 0, f"{folder}: digest {digest}")
    expect(numbers["ranks"] == ranks, f"{folder}: {numbers['ranks']} ranks")
    expect(numbers["interrupted"] == (last_step is None), f"{folder}: interrupted {numbers['interrupted']}")
    step = numbers["steps"] if last_step is None else last_step
    rows = rows_of(folder)
    expect(list(rows[0])[:5] == COLUMNS, f"{folder}: columns {list(rows[0])}")
    expect(rows[0]["step"] == "0" and int(rows[-1]["step"]) == numbers["steps"] == step,
           f"{folder}: rows {rows[0]['step']} to {rows[-1]['step']}, {numbers['steps']} steps")
    for name in [f"step_{step:09}.pvtp", "run.pvd"] + [f"step_{step:09}_rank_{r}.vtp" for r in range(ranks)]:
        expect(os.path.exists(f"{folder}/snapshots/{name}"), f"{folder}: no snapshots/{name}")
    expect(os.path.getsize(folder + "/picture.png") > 1000, f"{folder}: no picture")
    leftovers = [name for _, _, names in os.walk(folder) for name in names if "tmp" in name or name.startswith(".")]
    expect(not leftovers, f"{folder}: left over: {leftovers}")
    return numbers


def check_runs():
    write("case.toml", DECK)
    digests = set()
    for ranks in (1, 2):
        out = f"ranks{ranks}.out"
        fresh(out)
        done = run("run", "case.toml", "--out", out, ranks=ranks)
        expect(done.returncode == 0, f"{ranks} ranks: {done.stderr}")
        expect("digest" in done.stdout and out in done.stdout, f"{ranks} ranks, summary: {done.stdout}")
        digests.add(check_whole(out, ranks, 200)["state_digest"])
        expect(len(rows_of(out)) == 101, f"{ranks} ranks: {len(rows_of(out))} rows")
    expect(len(digests) == 1, f"ranks 1 and 2 differ: {digests}")
    fresh("case.out")
    done = run("run", "case.toml", "--steps", "4", "--quiet")
    expect(done.returncode == 0 and done.stdout == "" and done.stderr == "", f"--quiet: {done}")
    check_whole("case.out", 1, 4)


def check_ring():
    write("ring.toml", edited(("region = { lo = [0.0, 0.2], hi = [4.0, 0.8] }", "region = { lo = [0.0, 0.2], hi = [1.0, 0.8] }"),
                              ("[[wall]]", RING.lstrip() + "\n[[wall]]")))
    fresh("ring.out")
    done = run("run", "ring.toml", "--steps", "3", "--quiet", ranks=2)
    expect(done.returncode == 0, f"ring: {done.stderr}")
    first = rows_of("ring.out")[0]
    for axis in "xy":
        expect(abs(float(first[f"ring1_diameter_{axis}"]) - 0.5) < 1e-12, f"ring: {first}")
    expect(first["bonds"] == "12", f"ring: {first['bonds']} bonds")


def check_signal(number, ranks):
    out = f"signal{number}_{ranks}.out"
    fresh(out)
    process = start("run", "case.toml", "--steps", "100000000", "--set", "output.series_every=50", "--out", out, ranks=ranks)
    deadline = time.time() + SECONDS
    while time.time() < deadline and not (os.path.exists(out + "/series.csv") and len(rows_of(out)) > 2):
        time.sleep(0.1)
    time.sleep(0.3)
    target = process.pid if ranks == 1 else next(pid for pid in children_of(process.pid) if rank_of(pid) == 0)
    os.kill(target, number)
    stdout, stderr = process.communicate(timeout=SECONDS)
    expect(process.returncode == 0, f"signal {number}, {ranks} ranks: status {process.returncode}, {stderr}")
    expect("Interrupted at step" in stdout, f"signal {number}, {ranks} ranks: {stdout}")
    check_whole(out, ranks, None)


check_runs()
check_ring()
check_signal(signal.SIGTERM, 1)
check_signal(signal.SIGINT, 1)
check_signal(signal.SIGTERM, 2)
finish()
