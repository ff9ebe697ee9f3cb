"""Runs that are to fail: started, harmed while they run, and judged by status and message."""
import atexit
import json
import os
import signal
import subprocess
import time

from _helper import DECK, SECONDS, expect, fresh, messages, start, write

LONG = ("--steps", "100000000", "--quiet", "--set", "output.series_every=50")
CHECKPOINTS = "\n[checkpoint]\nevery_steps = 50\nkeep = 3\n"


def begin(*arguments, ranks=1):
    process = start(*arguments, ranks=ranks)
    atexit.register(process.kill)  # should this script fail before its end
    return process


def wait_for(is_so, what, seconds=SECONDS):
    deadline = time.time() + seconds
    while time.time() < deadline and not is_so():
        time.sleep(0.05)
    so = is_so()
    expect(so, f"waited in vain for {what}")
    return so


def has_rows(out, count=3):
    try:
        with open(out + "/series.csv", encoding="utf-8") as file:
            return len(file.readlines()) > count
    except OSError:
        return False


def checkpoints_of(out):
    try:
        return sorted(n for n in os.listdir(out + "/checkpoints") if n[5:].isdigit())
    except OSError:
        return []


def digest_of(out):
    with open(out + "/run.json", encoding="utf-8") as file:
        return json.load(file)["state_digest"]


def log_of(out):
    try:
        with open(out + "/log.txt", encoding="utf-8") as file:
            return file.read()
    except OSError:
        return ""


def expect_failure(name, done, *parts, status=1):
    """@param done  a process that has ended, with text"""
    said = messages(done)
    errors = [line for line in said if "warning" not in line]
    expect(done.returncode == status, f"{name}: status {done.returncode}: {done.stderr[-2000:]}")
    expect(len(errors) == 1, f"{name}: {len(errors)} errors: {said}: {done.stderr[-2000:]}")
    for part in parts:
        expect(any(part in line for line in errors), f"{name}: no '{part}' in {said}")


def ended(process, seconds=SECONDS):
    """As run() gives it. A run that hangs is ended, and told."""
    try:
        out, err = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        expect(False, "a run hangs: " + " ".join(process.args))
        process.kill()
        out, err = process.communicate()
    return subprocess.CompletedProcess(process.args, process.returncode, out, err)


def while_running(name, ranks, harm, *parts, more=(), stop=True):
    """Starts a long run, does it harm, asks it to end, and expects an error."""
    out = "harmed.out"
    fresh(out)
    process = begin("run", "case.toml", "--out", out, *LONG, *more, ranks=ranks)
    wait_for(lambda: has_rows(out), f"{name}: rows")
    harm(out)
    if stop:
        process.send_signal(signal.SIGTERM)
    expect_failure(f"{name}, {ranks} ranks", ended(process), *parts)
    return out


write("case.toml", DECK)
write("saved.toml", DECK + CHECKPOINTS)
