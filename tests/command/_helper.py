"""Runs the command for the scripts beside this file."""
import os
import shutil
import subprocess
import sys
import time

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from work_folder import leave_tree  # noqa: E402

COMMAND = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.environ["BARCHAN_COMMAND"])
leave_tree(os.path.splitext(os.path.basename(sys.argv[0]))[0])
SECONDS = 240  # for anything to end, however slow the machine

DECK = """
dimension = 2
gravity = [0.0, -9.81]

[domain]
lo = [0.0, 0.0]
hi = [4.0, 1.0]

[time]
step = 1e-4
steps = 200

[[material]]
name = "sand"
density = 1000.0
normal_stiffness = 1e5
tangential_stiffness = 5e4
restitution = 0.5
friction = 0.5

[[particles]]
kind = "lattice"
region = { lo = [0.0, 0.2], hi = [4.0, 0.8] }
radius = 0.04
material = "sand"

[[wall]]
name = "floor"
point = [0.0, 0.0]
normal = [0.0, 1.0]
material = "sand"
"""

failures = []


def command_line(arguments, ranks):
    launcher = [] if ranks == 1 else ["mpirun", "-n", str(ranks)]
    return launcher + [COMMAND] + [str(a) for a in arguments]


def run(*arguments, ranks=1):
    """The finished process, with its output as text."""
    return subprocess.run(command_line(arguments, ranks), stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=SECONDS)


def start(*arguments, ranks=1):
    return subprocess.Popen(command_line(arguments, ranks), stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


def messages(done):
    """What the command itself said on stderr; mpirun adds words of its own."""
    return [line for line in done.stderr.splitlines() if line.startswith("barchan: ")]


def expect(is_so, what):
    if not is_so:
        failures.append(what)
        print("FAILED: " + what, flush=True)


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def replaced(text, *changes):
    """A text with pieces of it replaced, each where it stands first."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def edited(*changes):
    """The deck above with pieces of its text replaced."""
    return replaced(DECK, *changes)


def fresh(*paths):
    for path in paths:
        if os.path.isdir(path):
            shutil.rmtree(path)
        elif os.path.exists(path):
            os.remove(path)


def shell(*words):
    """Whether a command of the system ended well."""
    return subprocess.run(words, capture_output=True, text=True).returncode == 0


def timed(check, *arguments):
    begin = time.time()
    check(*arguments)
    print(f"{check.__name__}{arguments}: {time.time() - begin:.1f} s", flush=True)


def finish():
    print("all passed" if not failures else f"{len(failures)} failed")
    sys.exit(1 if failures else 0)
