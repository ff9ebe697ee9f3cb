"""watch says how far a run is, that it has ended, or that it died."""
import os
import signal
import time

from _helper import DECK, expect, finish, fresh, messages, run, start, write


def check_running_and_dead():
    fresh("long.out")
    process = start("run", "case.toml", "--out", "long.out", "--steps", "100000000", "--quiet", "--set", "output.series_every=500")
    for _ in range(400):
        if os.path.exists("long.out/progress.json") or process.poll() is not None:
            break
        time.sleep(0.05)
    done = run("watch", "long.out", "--once")
    for word in ("of 100,000,000", "left", "a step", "kinetic", "contacts"):
        expect(done.returncode == 0 and word in done.stdout, f"watch: no '{word}' in {done}")
    process.send_signal(signal.SIGKILL)
    process.communicate()
    done = run("watch", "long.out")
    expect(done.returncode == 1 and "died" in done.stderr and len(messages(done)) == 1, f"a run that died: {done}")


def check_ended():
    fresh("short.out")
    run("run", "case.toml", "--out", "short.out", "--quiet")
    done = run("watch", "short.out")
    expect(done.returncode == 0 and "ended" in done.stdout and "digest" in done.stdout, f"a run that has ended: {done}")
    expect(not os.path.exists("short.out/progress.json"), "progress of a run that has ended")


def check_wrong_input():
    os.makedirs("empty", exist_ok=True)
    for words in (("nowhere",), ("empty",), ("short.out", "--interval", "0")):
        done = run("watch", *words)
        expect(done.returncode == 2 and len(messages(done)) == 1, f"watch {words}: {done}")


write("case.toml", DECK)
check_running_and_dead()
check_ended()
check_wrong_input()
finish()
