"""Signals and closed streams: a run that is hung up on is saved, a reader that goes away ends nothing, and what a killed launcher
leaves in shared memory the next run removes."""
import glob
import json
import os
import signal
import socket
import subprocess
import tempfile
import time

from _faults import CHECKPOINTS, LONG, begin, checkpoints_of, ended, has_rows, wait_for
from _helper import DECK, SECONDS, command_line, expect, finish, fresh, run, timed, write
from processes import children_of, is_there, rank_of

write("saved.toml", DECK + CHECKPOINTS)
ARGUMENTS = ("run", "saved.toml", "--out", "signal.out")
SHORT = ("--steps", "3000", "--set", "output.series_every=50")


def is_saved_at_the_end(out):
    with open(out + "/run.json", encoding="utf-8") as file:
        numbers = json.load(file)
    return numbers["interrupted"] and f"step_{numbers['steps']:09}" in checkpoints_of(out)


def check_hang_up(ranks):
    fresh("signal.out")
    process = begin(*ARGUMENTS, *LONG, "--set", "checkpoint.every_steps=100000000", ranks=ranks)
    wait_for(lambda: has_rows("signal.out"), "rows")
    target = process.pid if ranks == 1 else next(pid for pid in children_of(process.pid) if rank_of(pid) == 1)
    os.kill(target, signal.SIGHUP)
    done = ended(process)
    expect(done.returncode == 0, f"SIGHUP, {ranks} ranks: {done.returncode}, {done.stderr}")
    expect(is_saved_at_the_end("signal.out"), f"SIGHUP, {ranks} ranks: not saved, {checkpoints_of('signal.out')}")


def check_launcher_ended():
    """mpirun that gets SIGTERM hands it on after its limit, and leaves ranks the same time once more to save."""
    fresh("signal.out")
    line = ["mpirun", "--mca", "odls_base_sigkill_timeout", "3", *command_line((*ARGUMENTS, *LONG), 2)[1:]]
    process = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for(lambda: has_rows("signal.out"), "rows")
    process.send_signal(signal.SIGTERM)
    ended(process)  # with a status that is mpirun's own
    expect(is_saved_at_the_end("signal.out"), f"SIGTERM to mpirun: not saved, {checkpoints_of('signal.out')}")


def check_nohup():
    """Who asked that hanging up be ignored is obeyed."""
    fresh("signal.out")
    process = subprocess.Popen(command_line((*ARGUMENTS, *LONG), 1), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    wait_for(lambda: has_rows("signal.out"), "rows")
    process.send_signal(signal.SIGHUP)
    time.sleep(0.5)
    expect(process.poll() is None, "SIGHUP ended a run under nohup")
    process.send_signal(signal.SIGTERM)
    expect(ended(process).returncode == 0, "SIGTERM under nohup")


def check_closed_pipes(ranks):
    """stdout and stderr are pipes whose readers are gone before the first word."""
    fresh("signal.out")
    process = subprocess.Popen(command_line((*ARGUMENTS, *SHORT), ranks), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdout.close()
    process.stderr.close()
    status = process.wait(timeout=SECONDS)
    expect(status == 0, f"closed pipes, {ranks} ranks: status {status}")
    expect(os.path.exists("signal.out/run.json"), f"closed pipes, {ranks} ranks: no results")


def check_closed_streams():
    """No streams at all: what is printed must not land in a file of the run."""
    fresh("signal.out")
    line = " ".join(command_line((*ARGUMENTS, "--steps", "100", "--set", "output.series_every=1"), 1))
    status = subprocess.run(["sh", "-c", f"exec {line} <&- >&- 2>&-"], timeout=SECONDS, check=False).returncode
    expect(status == 0, f"closed streams: status {status}")
    with open("signal.out/series.csv", encoding="utf-8") as file:
        lines = file.readlines()
    expect(len(lines) == 102 and len({line.count(",") for line in lines}) == 1, "closed streams: words in series.csv")


def left_over():
    host, uid = socket.gethostname().split(".")[0], os.geteuid()
    names = [p for p in glob.glob(f"/dev/shm/*.{host}*") if os.stat(p).st_uid == uid]
    return set(names + glob.glob(f"{tempfile.gettempdir()}/ompi.{host}*.{uid}/pid.*"))


def check_killed_launcher(exchange):
    """SIGKILL of mpirun: its files in shared memory and its session folder are gone after the next run; of runs that live
    nothing goes."""
    fresh("signal.out", "other.out")
    before = left_over()
    process = begin(*ARGUMENTS, *LONG, "--exchange", exchange, ranks=2)
    wait_for(lambda: has_rows("signal.out"), "rows")
    ranks = children_of(process.pid)
    mine = [path for path in left_over() - before if is_of(path, process.pid, ranks)]
    other = begin("run", "saved.toml", "--out", "other.out", *LONG, "--exchange", exchange, ranks=2)
    wait_for(lambda: has_rows("other.out"), "rows of the other run")
    process.kill()
    ended(process)
    wait_for(lambda: not any(map(is_there, ranks)), "ranks to end with their launcher")
    if not any(map(os.path.exists, mine)):
        print(f"{exchange}: this MPI leaves nothing behind")
    time.sleep(2.1)  # files younger than a second stay
    fresh("signal.out")
    done = run(*ARGUMENTS, "--steps", "50", "--quiet", ranks=2)
    expect(done.returncode == 0, f"{exchange}: the next run: {done.stderr}")
    left = [path for path in mine if os.path.exists(path)]
    expect(not left, f"{exchange}: still there: {left}")
    for pid in children_of(other.pid):
        if rank_of(pid) == 0:
            os.kill(pid, signal.SIGTERM)
    done = ended(other)
    expect(done.returncode == 0, f"{exchange}: a run beside it: {done.returncode}, {done.stderr}")


def is_of(path, launcher, ranks):
    """Whether a file or folder belongs to these processes."""
    if path.endswith(f"/pid.{launcher}"):
        return True
    for pid in ranks:
        try:
            with open(f"/proc/{pid}/maps", encoding="utf-8") as file:
                if path in file.read():
                    return True
        except OSError:
            pass
    return False


for num_ranks in (1, 2):
    timed(check_hang_up, num_ranks)
    timed(check_closed_pipes, num_ranks)
timed(check_launcher_ended)
timed(check_nohup)
timed(check_closed_streams)
for name in ("shared", "put-flag"):
    timed(check_killed_launcher, name)
finish()
