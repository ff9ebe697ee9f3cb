"""Memory that is not there, a rank that hangs, a run that goes wrong: a clear error once, the status that docs/run_folder.md
says, and no rank is left waiting."""
import json
import os
import random
import signal
import subprocess
import time

from _faults import LONG, begin, digest_of, ended, expect_failure, has_rows, log_of, wait_for
from _helper import COMMAND, edited, expect, finish, fresh, messages, run, timed, write
from processes import children_of, is_there, name_of, rank_of

MORE_MEMORY = 64 << 20  # than a small run takes; not enough for a million particles


def with_peak(pid):
    """The most address space that a process has had [bytes]; threads and MPI take what the machine's cores ask for."""
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        return next(int(line.split()[1]) << 10 for line in file if line.startswith("VmPeak:"))


def peak_of_small_run(ranks):
    fresh("small.out")
    process = begin("run", "case.toml", "--out", "small.out", *LONG, ranks=ranks)
    wait_for(lambda: has_rows("small.out"), "rows of a small run")
    peak = max(with_peak(pid) for pid in ([process.pid] if ranks == 1 else children_of(process.pid)))
    process.send_signal(signal.SIGTERM)
    ended(process)
    return peak


def check_memory():
    write("large.toml", edited(("hi = [4.0, 1.0]", "hi = [1000.0, 100.0]"),
                               ("hi = [4.0, 0.8]", "hi = [1000.0, 40.0]"), ("radius = 0.04", "radius = 0.1")))
    rich = [COMMAND, "run", "large.toml", "--quiet", "--steps", "1"]
    for ranks in (1, 2):
        fresh("large.out")
        limit = (peak_of_small_run(ranks) + MORE_MEMORY) >> 10
        poor = ["sh", "-c", f'ulimit -v {limit}; exec "$@"', "sh", *rich]
        line = poor if ranks == 1 else ["mpirun", "-n", "1", *rich, ":", "-n", "1", *poor]
        process = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        expect_failure(f"memory, one of {ranks} ranks", ended(process), "out of memory")


def hang(name, limit, begun, *more):
    """Stops the last of three ranks once begun(process). @return the run as it ended, what it said"""
    fresh("hang.out")
    os.environ["BARCHAN_WAIT_LIMIT"] = str(limit)
    process = begin("run", "case.toml", "--out", "hang.out", *LONG, "--exchange", "put-flag", "--threads", "1", *more, ranks=3)
    del os.environ["BARCHAN_WAIT_LIMIT"]
    wait_for(lambda: begun(process), f"{name}: its beginning")
    stopped = next((pid for pid in children_of(process.pid) if rank_of(pid) == 2), None)
    expect(stopped is not None, f"{name}: rank 2 has gone, status {process.poll()}")
    if stopped is None:
        return messages(ended(process))
    os.kill(stopped, signal.SIGSTOP)
    done = ended(process)
    said = messages(done)
    expect(done.returncode == 1, f"{name}: status {done.returncode}: {done.stderr}")
    expect(any("gave up after waiting" in line for line in said), f"{name}: {done.stderr}")
    expect(not any("rank 2:" in line for line in said), f"{name}: the rank that hangs speaks: {said}")
    wait_for(lambda: not is_there(stopped), f"{name}: the stopped rank to go")
    return said


def check_hang(rows_every):
    """@param rows_every  1: most likely the rank is stopped while all add up a row; many: in a step"""
    name = f"hang, a row every {rows_every} steps"
    # The row of step 0: the next may be long in coming on a loaded machine.
    said = hang(name, 5, lambda _: has_rows("hang.out", 1), "--set", f"output.series_every={rows_every}")
    if rows_every > 1:
        expect(any("rank 1: " in line and ("rank 2 (right)" in line or "missing: rank 2" in line or ": MPI_" in line)
                   for line in said),
               f"{name}: rank 1 does not say for whom it waits: {said}")


def check_hang_at_start():
    """A rank that hangs while others set up windows and communicators, in calls that cannot be asked how they get on."""
    def has_begun(process):
        ranks = [pid for pid in children_of(process.pid) if rank_of(pid) == 2 and name_of(pid) == "barchan"]
        if ranks:
            time.sleep(random.uniform(0.0, 0.3))
        return bool(ranks)
    hang("hang at the start", 3, has_begun)


def check_wild():
    """A step far too long: the run blows up and says where, in the same words however many ranks and threads there are. Many
    particles go wild in one step, on several ranks and soon on those beside."""
    write("wild.toml", edited(("step = 1e-4", "step = 5e-2\nallow_unstable = true")))
    said = {}
    for ranks, threads, exchange in ((1, 1, "auto"), (1, 3, "auto"), (2, 1, "put-flag"), (2, 2, "isend"), (3, 1, "get")):
        way = f"wild, {ranks} ranks of {threads} threads, {exchange}"
        fresh("wild.out")
        done = run("run", "wild.toml", "--quiet", "--threads", threads, "--exchange", exchange, ranks=ranks)
        expect_failure(way, done, "particle ", "with velocity", "touching")
        said[way] = [line for line in messages(done) if "warning" not in line]
    expect(len({str(lines) for lines in said.values()}) == 1, f"wild: not the same words: {said}")


def check_outside():
    bouncing = edited(("[[wall]]", "[checkpoint]\nevery_steps = 1000000\n\n[[wall]]"), ("hi = [4.0, 1.0]", "hi = [4.0, 0.805]"),
                      ("material = \"sand\"\n\n[checkpoint]", "material = \"sand\"\nvelocity = [0.0, 6.0]\n\n[checkpoint]"))
    write("open.toml", bouncing)
    out = "open.out"
    fresh(out, "whole.out")
    done = run("run", "open.toml", "--quiet", "--out", out, ranks=2)
    expect_failure("outside", done, "is out of the domain, at (", "the last checkpoint is")
    expect(not os.path.exists(out + "/run.json"), "outside: run.json is there")
    with open(out + "/left_domain.csv", encoding="utf-8") as file:
        lines = file.read().splitlines()
    expect(lines[0] == "step,id,x,y,vx,vy" and len(lines) > 1, f"outside: {lines[:3]}")
    expect("error: at step" in log_of(out), "outside: the log has no error")
    check_deleted(out)


def check_deleted(out):
    delete = ("--quiet", "--set", "domain.outside=delete")
    fresh(out)
    whole = run("run", "open.toml", "--out", "whole.out", *delete)
    half = run("run", "open.toml", "--out", out, *delete, "--steps", "190", ranks=2)
    rest = run("run", "open.toml", "--out", out, *delete, "--restart", "auto", ranks=3)
    for done in (whole, half, rest):
        expect(done.returncode == 0, f"outside, deleted: {done.stderr}")
    expect(digest_of(out) == digest_of("whole.out"), "outside, deleted: another digest after a restart")
    with open(f"{out}/left_domain.csv", encoding="utf-8") as mine, open("whole.out/left_domain.csv", encoding="utf-8") as theirs:
        expect(mine.read() == theirs.read(), "outside, deleted: another left_domain.csv")
    with open("whole.out/run.json", encoding="utf-8") as file:
        numbers = json.load(file)
    expect(numbers["left_domain"]["particles"] > 10, f"outside: {numbers['left_domain']}")


timed(check_outside)
timed(check_wild)
timed(check_hang_at_start)
timed(check_hang, 1)
timed(check_hang, 5000)
timed(check_memory)
finish()
