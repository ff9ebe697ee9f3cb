"""Disks that are full or become read-only, files that go or change, damaged checkpoints: a clear error once, the status that
docs/run_folder.md says, and what was there before stays good."""
import atexit
import os
import shutil
import signal
import sys

from _faults import (LONG, begin, checkpoints_of, digest_of, ended, expect_failure, has_rows, log_of, wait_for,
                     while_running)
from _helper import expect, finish, fresh, messages, run, shell, timed, write

DISK = os.path.abspath("disk")


def mount(size):
    """A small disk of its own; false where this system does not let us."""
    os.makedirs(DISK, exist_ok=True)
    unmount()
    return shell("mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", DISK)


def unmount():
    if os.path.ismount(DISK):
        shell("umount", DISK) or shell("umount", "-l", DISK)


def put_folder(name):
    def harm(out):
        os.makedirs(f"{out}/{name}/in the way")
    return harm


def put_file_for_folder(name):
    def harm(out):
        os.rename(f"{out}/{name}", f"{out}/moved away")
        write(f"{out}/{name}", "in the way")
    return harm


def check_files_in_the_way():
    while_running("picture", 1, put_folder("picture.png"), "picture.png")
    while_running("run.json", 1, put_folder("run.json"), "run.json")
    while_running("trace", 1, put_folder("trace.json"), "trace.json", more=("--trace",))
    # mpirun gives ranks a second after SIGTERM, so the harm itself must end this one.
    out = while_running("snapshots", 2, put_file_for_folder("snapshots"), "snapshots",
                        more=("--set", "output.snapshots_every=100"), stop=False)
    expect(has_rows(out), "snapshots: the series is gone")
    expect("error: " in log_of(out), "snapshots: the log has no error")
    while_running("series removed", 2, lambda out: os.remove(out + "/series.csv"), "was removed", stop=False)
    while_running("series cut", 1, lambda out: os.truncate(out + "/series.csv", 10), "was changed", stop=False)


def check_full_disk(ranks, undisturbed):
    """Snapshots fill the disk: the checkpoints that are there stay good, and the run goes on from them with more room."""
    name = f"full disk, {ranks} ranks"
    expect(mount("1m"), "a small disk")
    out = DISK + "/case.out"
    arguments = ("run", "saved.toml", "--out", out, "--quiet", "--restart", "auto")
    done = run(*arguments, "--steps", "60")
    expect(done.returncode == 0, f"{name}: {done.stderr}")
    before = checkpoints_of(out)
    room = shutil.disk_usage(DISK).free
    with open(DISK + "/ballast", "wb") as file:
        file.write(bytes(max(0, room - (150 << 10))))
    done = run(*arguments, "--set", "output.snapshots_every=20", ranks=ranks)
    expect_failure(name, done, "No space left on device")
    expect(not os.path.exists(out + "/run.json"), f"{name}: there is a run.json")
    expect(set(before) & set(checkpoints_of(out)), f"{name}: of checkpoints {before} {checkpoints_of(out)} are left")
    os.remove(DISK + "/ballast")
    again = run(*arguments, ranks=3 - ranks)
    expect(again.returncode == 0, f"{name}: {again.stderr}")
    expect(digest_of(out) == undisturbed, f"{name}: another digest after the restart")
    unmount()


def begin_with_folder_on_disk(name, ranks, *more):
    """A run whose folder `name` lies on the disk by itself, so that no file that stays open keeps the disk writable."""
    out = "harmed.out"
    expect(mount("100m"), "a disk")
    fresh(out)
    done = run("run", "saved.toml", "--out", out, "--quiet", "--steps", "60")
    expect(done.returncode == 0, f"before {name} become read-only: {done.stderr}")
    shutil.move(f"{out}/{name}", f"{DISK}/{name}")
    os.symlink(f"{DISK}/{name}", f"{out}/{name}")
    there = set(os.listdir(f"{DISK}/{name}"))
    process = begin("run", "saved.toml", "--out", out, *LONG, "--restart", "auto", *more, ranks=ranks)
    wait_for(lambda: set(os.listdir(f"{DISK}/{name}")) - there, f"new {name}")
    wait_for(lambda: shell("mount", "-o", "remount,ro", DISK), "a moment in which no file is open")
    return process, out


def check_read_only_snapshots(ranks):
    process, _ = begin_with_folder_on_disk("snapshots", ranks, "--set", "output.snapshots_every=5000",
                                           "--set", "checkpoint.every_steps=0")
    expect_failure("read-only snapshots", ended(process), "Read-only file system")
    unmount()


def check_read_only_checkpoints(ranks):
    process, out = begin_with_folder_on_disk("checkpoints", ranks, "--set", "checkpoint.every_steps=5000")
    wait_for(lambda: "could not be written" in log_of(out), "a warning")
    process.send_signal(signal.SIGTERM)
    done = ended(process)
    expect(any("warning" in line and "Read-only file system" in line for line in messages(done)),
           f"read-only checkpoints, {ranks} ranks: {done.stderr}")
    if ranks == 1:  # mpirun may be faster
        expect_failure("read-only checkpoints", done, "its last state could not be saved")
    unmount()


def check_read_only_from_the_start():
    expect(mount("1m") and shell("mount", "-o", "remount,ro", DISK), "a read-only disk")
    for ranks in (1, 2):
        expect_failure(f"read-only from the start, {ranks} ranks",
                       run("run", "case.toml", "--out", DISK + "/case.out", "--quiet", ranks=ranks),
                       "cannot write", "Read-only", status=2)
    unmount()


def check_damaged_checkpoints(undisturbed):
    out = "saved.out"
    fresh(out)
    expect(run("run", "saved.toml", "--out", out, "--quiet").returncode == 0, "the run to be damaged")
    names = checkpoints_of(out)
    expect(len(names) == 3, f"checkpoints: {names}")
    with open(f"{out}/checkpoints/{names[-1]}/rank_00000.bin", "r+b") as file:
        file.seek(2000)
        byte = file.read(1)[0]
        file.seek(2000)
        file.write(bytes([byte ^ 16]))
    os.truncate(f"{out}/checkpoints/{names[-2]}/rank_00000.bin", 4000)
    done = run("run", "saved.toml", "--out", out, "--quiet", "--restart", "auto", ranks=2)
    expect(done.returncode == 0, f"damaged checkpoints: {done.stderr}")
    skipped = [line for line in messages(done) if "skipped a checkpoint" in line]
    expect(len(skipped) == 2, f"damaged checkpoints: {messages(done)}")
    expect(digest_of(out) == undisturbed, "damaged checkpoints: another digest")


def check_series_changed_between_runs():
    """Whoever cuts a series is told at the restart, which goes on."""
    out = "edited.out"
    fresh(out)
    expect(run("run", "saved.toml", "--out", out, "--quiet", "--steps", "150").returncode == 0, "the run before an edit")
    with open(out + "/series.csv", encoding="utf-8") as file:
        rows = file.readlines()
    write(out + "/series.csv", "".join(rows[:20]))
    done = run("run", "saved.toml", "--out", out, "--quiet", "--restart", "auto", ranks=2)
    expect(done.returncode == 0, f"edited series: {done.stderr}")
    expect(any("warning" in line and "series.csv: rows between step" in line for line in messages(done)),
           f"edited series: {done.stderr}")
    expect("warning: " in log_of(out), "edited series: the log has no warning")


atexit.register(unmount)
fresh("undisturbed.out")
first = run("run", "saved.toml", "--out", "undisturbed.out", "--quiet")
expect(first.returncode == 0, first.stderr)
expected = digest_of("undisturbed.out")
timed(check_files_in_the_way)
timed(check_damaged_checkpoints, expected)
timed(check_series_changed_between_runs)
if mount("1m"):
    unmount()
    for num_ranks in (1, 2):
        timed(check_full_disk, num_ranks, expected)
        timed(check_read_only_snapshots, num_ranks)
        timed(check_read_only_checkpoints, num_ranks)
    timed(check_read_only_from_the_start)
else:
    print("skipped: this system does not let us mount a small disk", file=sys.stderr)
finish()
