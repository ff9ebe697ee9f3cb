"""Disks that are full or read-only, files that go, memory that is not there, a rank that hangs: a clear error once, the
status that docs/run_folder.md says, what was there before stays good, and no rank is left waiting."""
import atexit
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time

from _helper import COMMAND, DECK, edited, expect, finish, fresh, messages, run, start, write

DISK = os.path.abspath("disk")
MEMORY = 350 << 20  # enough for MPI and a small run
LONG = ("--steps", "100000000", "--quiet", "--set", "output.series_every=50")
CHECKPOINTS = "\n[checkpoint]\nevery_steps = 50\nkeep = 3\n"


def shell(*words):
    return subprocess.run(words, capture_output=True, text=True).returncode == 0


def mount(size):
    """A small disk of its own; false where this system does not let us."""
    os.makedirs(DISK, exist_ok=True)
    shell("umount", DISK)
    return shell("mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", DISK)


def unmount():
    if os.path.ismount(DISK):
        shell("umount", DISK) or shell("umount", "-l", DISK)


def begin(*arguments, ranks=1):
    process = start(*arguments, ranks=ranks)
    atexit.register(process.kill)  # should this script fail before its end
    return process


def wait_for(is_so, what, seconds=60):
    deadline = time.time() + seconds
    while time.time() < deadline and not is_so():
        time.sleep(0.05)
    expect(is_so(), f"waited in vain for {what}")


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
    with open(out + "/log.txt", encoding="utf-8") as file:
        return file.read()


def expect_failure(name, done, *parts, status=1):
    """@param done  a process that has ended, with text"""
    said = messages(done)
    errors = [line for line in said if "warning" not in line]
    expect(done.returncode == status, f"{name}: status {done.returncode}: {done.stderr[-2000:]}")
    expect(len(errors) == 1, f"{name}: {len(errors)} errors: {said}")
    for part in parts:
        expect(any(part in line for line in errors), f"{name}: no '{part}' in {said}")


def ended(process, seconds=60):
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
    done = ended(process)
    expect_failure(f"{name}, {ranks} ranks", done, *parts)
    return out


def put_folder(name):
    def harm(out):
        path = f"{out}/{name}"
        os.makedirs(path + "/in the way")
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


def put_read_only(name):
    """The folder is on a disk that cannot be written any more. One in use cannot be made so; it is put in its place."""
    def harm(out):
        os.rename(f"{out}/{name}", f"{out}/moved away")
        os.symlink(DISK, f"{out}/{name}")
    return harm


def check_read_only(ranks):
    expect(mount("1m") and shell("mount", "-o", "remount,ro", DISK), "a read-only disk")
    while_running("read-only snapshots", ranks, put_read_only("snapshots"), "Read-only file system",
                  more=("--set", "output.snapshots_every=500"), stop=False)
    out = "harmed.out"
    fresh(out)
    process = begin("run", "saved.toml", "--out", out, *LONG, "--set", "checkpoint.every_steps=1000", ranks=ranks)
    wait_for(lambda: checkpoints_of(out), "a checkpoint")
    put_read_only("checkpoints")(out)
    wait_for(lambda: "could not be written" in log_of(out), "a warning")
    process.send_signal(signal.SIGTERM)
    done = ended(process)
    expect(any("warning" in line and "Read-only file system" in line for line in messages(done)),
           f"read-only checkpoints: {messages(done)}")
    if ranks == 1:  # mpirun may be faster
        expect_failure("read-only checkpoints", done, "its last state could not be saved")
    unmount()


def check_read_only_from_the_start():
    expect(mount("1m"), "a mount")
    shell("mount", "-o", "remount,ro", DISK)
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


def check_memory():
    write("large.toml", edited(("hi = [4.0, 1.0]", "hi = [1000.0, 100.0]"),
                               ("hi = [4.0, 0.8]", "hi = [1000.0, 40.0]"), ("radius = 0.04", "radius = 0.1")))

    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    fresh("large.out")
    process = subprocess.Popen([COMMAND, "run", "large.toml", "--quiet", "--steps", "1"], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, preexec_fn=limit)
    expect_failure("memory, 1 rank", ended(process), "out of memory")
    poor = ["sh", "-c", f"ulimit -v {MEMORY >> 10}; exec {COMMAND} run large.toml --quiet --steps 1"]
    process = subprocess.Popen(["mpirun", "-n", "1", COMMAND, "run", "large.toml", "--quiet", "--steps", "1", ":", "-n", "1"] + poor,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    expect_failure("memory, 1 of 2 ranks", ended(process), "out of memory")


def ranks_of(launcher):
    with open(f"/proc/{launcher}/task/{launcher}/children", encoding="utf-8") as file:
        children = [int(word) for word in file.read().split()]
    found = {}
    for pid in children:
        with open(f"/proc/{pid}/environ", "rb") as file:
            for entry in file.read().split(b"\0"):
                if entry.startswith(b"OMPI_COMM_WORLD_RANK="):
                    found[int(entry.split(b"=")[1])] = pid
    return found


def check_hang():
    os.environ["BARCHAN_WAIT_LIMIT"] = "1.5"
    out = "hang.out"
    fresh(out)
    process = begin("run", "case.toml", "--out", out, *LONG, "--exchange", "put-flag", "--threads", "1", ranks=3)
    wait_for(lambda: has_rows(out), "hang: rows")
    stopped = ranks_of(process.pid)[2]
    os.kill(stopped, signal.SIGSTOP)
    done = ended(process, 40)
    del os.environ["BARCHAN_WAIT_LIMIT"]
    said = messages(done)
    expect(done.returncode == 1, f"hang: status {done.returncode}")
    expect(any("in vain" in line and "rank 1: " in line and "from rank 2 (right)" in line and " of step " in line
               for line in said), f"hang: {said}")
    expect(not any("rank 2:" in line for line in said), f"hang: the rank that hangs speaks: {said}")
    expect(not os.path.exists(f"/proc/{stopped}") or "Z" in open(f"/proc/{stopped}/stat").read().split(")")[1][:3],
           "hang: the stopped rank is still there")


def check_wild(ranks):
    """A step far too long: the run blows up and says where."""
    write("wild.toml", edited(("step = 1e-4", "step = 5e-2\nallow_unstable = true")))
    fresh("wild.out")
    done = run("run", "wild.toml", "--quiet", ranks=ranks)
    expect_failure(f"wild, {ranks} ranks", done, "particle ", "with velocity", "touching")


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
    delete = ("--quiet", "--set", "domain.outside=delete")
    fresh(out)
    whole = run("run", "open.toml", "--out", "whole.out", *delete)
    half = run("run", "open.toml", "--out", out, *delete, "--steps", "190", ranks=2)
    rest = run("run", "open.toml", "--out", out, *delete, "--restart", "auto", ranks=3)
    for done in (whole, half, rest):
        expect(done.returncode == 0, f"outside, deleted: {done.stderr}")
    expect(digest_of(out) == digest_of("whole.out"), "outside, deleted: another digest after a restart")
    for name in ("left_domain.csv", "series.csv"):
        with open(f"{out}/{name}", encoding="utf-8") as mine, open(f"whole.out/{name}", encoding="utf-8") as theirs:
            same = mine.read() == theirs.read()
        expect(same or name == "series.csv", f"outside, deleted: another {name}")
    with open("whole.out/run.json", encoding="utf-8") as file:
        numbers = json.load(file)
    expect(numbers["left_domain"]["particles"] > 10, f"outside: {numbers['left_domain']}")


atexit.register(unmount)
write("case.toml", DECK)
write("saved.toml", DECK + CHECKPOINTS)
fresh("undisturbed.out")
first = run("run", "saved.toml", "--out", "undisturbed.out", "--quiet")
expect(first.returncode == 0, first.stderr)
expected = digest_of("undisturbed.out")
clock = time.time()


def timed(check, *arguments):
    global clock
    check(*arguments)
    print(f"{check.__name__}{arguments}: {time.time() - clock:.1f} s", flush=True)
    clock = time.time()


timed(check_outside)
timed(check_wild, 1)
timed(check_wild, 2)
timed(check_files_in_the_way)
timed(check_damaged_checkpoints, expected)
timed(check_hang)
timed(check_memory)
if mount("1m"):
    unmount()
    timed(check_full_disk, 1, expected)
    timed(check_full_disk, 2, expected)
    timed(check_read_only, 1)
    timed(check_read_only, 2)
    timed(check_read_only_from_the_start)
else:
    print("skipped: this system does not let us mount a small disk", file=sys.stderr)
finish()
