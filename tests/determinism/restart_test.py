"""A run that ends early and goes on gives the files of one that was never interrupted.

usage: restart_test.py BARCHAN [--kills N [--steps S]] [--seed S]

Ends runs by their number of steps, by a signal, and by kill -9 of one rank at a random moment; goes on with --restart
auto, on other numbers of ranks and threads; then compares state digest, series.csv and snapshots with the undisturbed
run. A seed repeats the moments by rows of series.csv, so nearly.
"""

import argparse
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from processes import children_of, name_of, output_after_kill  # noqa: E402
from work_folder import SOURCE, leave_tree  # noqa: E402

STEPS, EVERY = 3000, 200
# The plate comes down early, so that all that a checkpoint holds is there when ranks are killed.
OPTIONS = ["--set", "stage.settle.max_time=0.1", "--set", "wall.plate.point=[8.0, 3.05]", "--set", "output.picture=false",
           "--set", "output.series_every=100", "--set", "output.snapshots_every=1000",
           "--set", f"checkpoint.every_steps={EVERY}", "--quiet"]
failures = []


def expect(is_so, what):
    if not is_so:
        failures.append(what)
        print("FAILED: " + what, flush=True)


def line_of(command, folder, ranks, threads, *more, steps=STEPS):
    launcher = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    return [*launcher, command, "run", str(SOURCE / "examples" / "soil_duct.toml"), *OPTIONS, "--steps",
            str(steps), "--threads", str(threads), "--out", folder, *more]


def run(*arguments, **more):
    return subprocess.run(line_of(*arguments, **more), capture_output=True, text=True, timeout=500)


def finished(folder):
    """digest, series and snapshots' list of a run that has ended"""
    with open(f"{folder}/run.json", encoding="utf-8") as file:
        digest = json.load(file)["state_digest"]
    series = pathlib.Path(folder, "series.csv").read_text(encoding="utf-8")
    pvd = pathlib.Path(folder, "snapshots", "run.pvd").read_text(encoding="utf-8")
    missing = [name for name in re.findall(r'file="([^"]+)"', pvd) if not pathlib.Path(folder, "snapshots", name).exists()]
    return digest, series, pvd, missing


def compare(folder, expected, what):
    got = finished(folder)
    for name, a, b in zip(("digest", "series.csv", "run.pvd", "missing snapshots"), got, expected):
        expect(a == b, f"{what}: {name} differs from the undisturbed run")


def stop_and_go_on(command, expected):
    shutil.rmtree("stopped", ignore_errors=True)
    first = run(command, "stopped", 1, 2, steps=1234)
    expect(first.returncode == 0, "1,234 steps: " + first.stderr)
    refused = run(command, "stopped", 2, 1, "--restart", "auto", steps=1000)
    expect(refused.returncode == 2 and "1234" in refused.stderr, "fewer steps than the checkpoint: " + refused.stderr)
    other = run(command, "stopped", 1, 1, "--restart", "auto", "--set", "gravity=[0.0, -1.0]")
    expect(other.returncode == 2 and "gravity" in other.stderr, "another deck is refused: " + other.stderr)
    second = run(command, "stopped", 3, 1, "--restart", "auto")
    expect(second.returncode == 0, "the rest on three ranks: " + second.stderr)
    compare("stopped", expected, "ended at 1,234 steps, went on on three ranks")
    numbers = json.loads(pathlib.Path("stopped/run.json").read_text())
    expect(numbers["loop_steps"] == STEPS - 1234, f"steps of the loop after a restart: {numbers['loop_steps']}")


def skip_damaged(command, expected):
    newest = sorted(pathlib.Path("stopped/checkpoints").iterdir())[-1]
    with open(newest / "rank_00000.bin", "r+b") as file:
        file.seek(5000)
        byte = file.read(1)[0]
        file.seek(5000)
        file.write(bytes([byte ^ 4]))
    done = run(command, "stopped", 2, 2, "--restart", "auto")
    expect(done.returncode == 0 and "skipped" in done.stderr and "checksum" in done.stderr, "damaged one is named: " + done.stderr)
    compare("stopped", expected, "went on from the checkpoint before a damaged one")


def wait_until(process, is_so):
    while process.poll() is None and not is_so():
        time.sleep(0.005)


def saved_in(folder):
    names = os.listdir(f"{folder}/checkpoints") if os.path.isdir(f"{folder}/checkpoints") else []
    return sorted(int(name[5:]) for name in names if name[5:].isdigit())


def save_on_signals(command):
    """A run without end, saved by one signal and ended by another, then continued to a step that is known by then."""
    without = ("--set", "checkpoint.every_steps=0")
    shutil.rmtree("signalled", ignore_errors=True)
    process = subprocess.Popen(line_of(command, "signalled", 1, 1, *without, steps=10**8),
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_until(process, lambda: rows_of("signalled") > 1)
    process.send_signal(signal.SIGUSR1)
    wait_until(process, lambda: saved_in("signalled"))
    process.send_signal(signal.SIGTERM)
    _, err = process.communicate(timeout=500)
    expect(process.returncode == 0, "ends well on SIGTERM: " + err)
    saved = saved_in("signalled")
    expect(len(saved) == 2, f"saves on signals: {saved}")
    steps = saved[-1] + 300
    for folder, ranks, more in (("signalled", 2, ["--restart", "auto"]), ("unsignalled", 1, ["--force"])):
        done = run(command, folder, ranks, 1, *without, *more, steps=steps)
        expect(done.returncode == 0, f"{folder}, {steps} steps: {done.stderr}")
    compare("signalled", finished("unsignalled"), f"saved on signals at {saved}")


def rows_of(folder):
    """Rows of series.csv so far: where the run is."""
    try:
        return pathlib.Path(folder, "series.csv").read_bytes().count(b"\n") - 1
    except OSError:
        return -1


def has_ended_before(process, is_time):
    """Waits for a moment; whether the process was faster."""
    while not is_time():
        if process.poll() is not None:
            return True
        time.sleep(0.001)
    return False


def random_moment(folder, rng, last_row):
    """Most kills strike somewhere between two rows, the others while ranks start, read or restore."""
    begin = time.monotonic()
    if rng.random() < 0.2:
        patience = rng.uniform(0.0, 1.5)
        return lambda: time.monotonic() - begin > patience
    row, at, delay = rng.uniform(max(rows_of(folder), 0), last_row), begin + 0.3, rng.uniform(0.0, 0.05)

    def is_time():  # rows of the run before are cut off while ranks start
        return time.monotonic() > at and rows_of(folder) >= row and not time.sleep(delay)
    return is_time


def killed_one_of(pids, rng):
    """@return name of the process that was killed; empty: none, it was faster"""
    if not pids:
        return ""
    pid = rng.choice(pids)
    name = name_of(pid)
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return ""
    return name


def is_excused(process, err, killed, command):
    """Whether a run that ended in failure did so over the kill. Open MPI's mpirun may fail without a word or hang for ever where
    what was killed is its own: a rank that it has forked and that has not begun yet."""
    told = process.returncode in (137, -9) or "signal 9" in err or "Killed" in err
    if killed == os.path.basename(command):
        return told
    if killed and not told:
        print(f"  '{killed}' was killed before it was a rank: status {process.returncode}, {err.strip()!r}", flush=True)
    return bool(killed)


def kill_and_go_on(command, expected, rng, number, steps):
    """Up to three kills in one run. @return how many struck a run under way"""
    folder, kills, last_row = "killed", [], steps // 100
    shutil.rmtree(folder, ignore_errors=True)
    while True:
        ranks, threads = rng.choice((2, 3, 4)), rng.choice((1, 2))
        process = subprocess.Popen(line_of(command, folder, ranks, threads, "--restart", "auto", steps=steps),
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        moment = random_moment(folder, rng, last_row)
        killed = ""
        if len(kills) < 3 and not has_ended_before(process, moment):
            killed = killed_one_of(children_of(process.pid), rng)
            if killed:
                kills.append(100 * max(rows_of(folder) - 1, 0))
        begin = time.monotonic()
        out, err = output_after_kill(process, 100)
        if time.monotonic() - begin > 100 and killed:
            print(f"  mpirun hung after '{killed}' was killed: {err.strip()!r}", flush=True)
        if process.returncode == 0:
            break
        if not is_excused(process, err, killed, command):
            expect(False, f"run {number}: a restart failed with status {process.returncode} after '{killed}' was "
                          f"killed: {err!r}, {out!r}")
            return len(kills)
    compare(folder, expected, f"run {number}, killed near steps {kills}")
    print(f"run {number}: killed near steps {kills}, ended on {ranks} ranks, {threads} threads", flush=True)
    return len(kills)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command", nargs="?", default=os.environ.get("BARCHAN_COMMAND"))
    parser.add_argument("--kills", type=int, default=2)
    parser.add_argument("--steps", type=int, default=STEPS, help="of the runs that are killed")
    parser.add_argument("--seed", type=int, default=random.randrange(10**6))
    arguments = parser.parse_args()
    arguments.command = os.path.abspath(arguments.command)
    leave_tree("restart_test")
    rng = random.Random(arguments.seed)
    print("seed", arguments.seed)
    shutil.rmtree("whole", ignore_errors=True)
    whole = run(arguments.command, "whole", 1, 1)
    expect(whole.returncode == 0, whole.stderr)
    expected = finished("whole")
    stop_and_go_on(arguments.command, expected)
    skip_damaged(arguments.command, expected)
    save_on_signals(arguments.command)
    if arguments.steps != STEPS:
        whole = run(arguments.command, "whole", 1, 1, "--force", steps=arguments.steps)
        expect(whole.returncode == 0, whole.stderr)
        expected = finished("whole")
    runs, kills = 0, 0
    while kills < arguments.kills:
        runs += 1
        kills += kill_and_go_on(arguments.command, expected, rng, runs, arguments.steps)
    print(f"{kills} kills in {runs} runs:", "all passed" if not failures else f"{len(failures)} failed")
    sys.exit(1 if failures else 0)


main()
