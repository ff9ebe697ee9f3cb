"""sweep runs every point and goes on where it stopped; table and compare say what the runs took."""
import json
import os
import signal
import subprocess
import time

from _helper import COMMAND, DECK, expect, finish, fresh, messages, run, write

QUICK = ("--steps", "20", "--set", "output.snapshots_every=0")


def made(folder, steps_of, **fields):
    """A sweep's folder by hand: {(exchange, repetition): µs a step}."""
    write_json(f"{folder}/sweep.json", {"axes": [{"axis": "exchange", "values": ["isend", "get"]}]})
    for (exchange, repetition), step in steps_of.items():
        home = f"{folder}/runs/exchange={exchange}"
        write_json(f"{home}/{repetition}.json", {"point": [{"axis": "exchange", "value": exchange}],
                                                 "repetition": repetition, "others": 0.0})
        write_json(f"{home}/{repetition}/run.json", {
            "deck": "case.toml", "steps": 1000, "loop_steps": 1000, "loop_seconds": step * 1e-3, "exchange": exchange,
            "particles": 350, "phases": {"forces": step * 0.5e-3, "wait": step * 0.5e-3},
            "communication": {"in_flight_seconds": 0.1, "exposed_seconds": 0.02, "hidden_fraction": 0.8},
            "state_digest": "0123456789abcdef", **fields})


def write_json(path, value):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    write(path, json.dumps(value))


def check_sweep():
    fresh("s")
    ask = ("sweep", "case.toml", "--out", "s", "--ranks", "1,2", "--schedule", "overlap", "--exchange", "isend",
           "--repeat", "1", *QUICK)
    done = run(*ask)
    expect(done.returncode == 0 and "ranks=2" in done.stderr, f"sweep: {done}")
    expect("digests: equal" in done.stdout.lower(), f"digests: {done.stdout}")
    homes = sorted(os.listdir("s/runs"))
    expect(homes == ["ranks=1,threads=1,exchange=isend,schedule=overlap", "ranks=2,threads=1,exchange=isend,schedule=overlap"],
           f"folders: {homes}")
    expect(not os.path.exists(f"s/runs/{homes[0]}/1/snapshots"), "snapshots were kept")
    stamp = os.stat(f"s/runs/{homes[0]}/1/run.json").st_mtime_ns
    os.remove(f"s/runs/{homes[1]}/1.json")  # as if it had been cut off
    done = run(*ask)
    expect(done.returncode == 0 and "1 of 2 runs are there" in done.stderr, f"sweep again: {done.stderr}")
    expect(os.stat(f"s/runs/{homes[0]}/1/run.json").st_mtime_ns == stamp, "a run that was there was made again")
    done = run(*ask, "--set", "time.step=5e-5")
    expect(done.returncode == 2 and "--force" in done.stderr, f"other settings in the same folder: {done.stderr}")
    rows = json.loads(run("table", "s", "--json").stdout)
    expect([p["point"]["ranks"] for p in rows["points"]] == ["1", "2"] and rows["digests_equal"], f"table: {rows}")
    with open(f"s/runs/{homes[0]}/1/run.json", encoding="utf-8") as file:
        expect(json.load(file)["deck_keys"]["material.1.name"] == '"sand"', "run.json does not tell the deck")


def check_launcher_and_failure():
    fresh("l", "f", "wrap.sh")
    write("wrap.sh", '#!/bin/sh\ntest "$2" = 1 || { echo "barchan: no second rank here" >&2; exit 3; }\nshift 2\nexec "$@"\n')
    os.chmod("wrap.sh", 0o755)
    done = run("sweep", "case.toml", "--out", "l", "--ranks", "1,2", "--exchange", "isend", "--repeat", "1", "--launcher",
               "./wrap.sh -n {ranks}", *QUICK)
    expect(done.returncode == 1 and "status 3: no second rank here" in done.stderr, f"a run that fails: {done}")
    expect("failed at 1 of 2 points" in done.stderr and len(json.loads(run("table", "l", "--json").stdout)["points"]) == 1,
           f"a sweep with a failed run: {done.stderr}")
    done = run("sweep", "case.toml", "--out", "f", "--ranks", "2", "--exchange", "isend", "--repeat", "2", "--launcher",
               "./wrap.sh -n {ranks}", *QUICK)
    expect(done.returncode == 1 and "failed at 1 of 1 points" in done.stderr and "has no run" not in done.stderr,
           f"a sweep of which every run failed: {done.stderr}")


def check_interrupt():
    fresh("i", "slow.sh")
    write("slow.sh", '#!/bin/sh\nexec sleep 60\n')
    os.chmod("slow.sh", 0o755)
    process = subprocess.Popen([COMMAND, "sweep", "case.toml", "--out", "i", "--ranks", "1", "--launcher", "./slow.sh"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    for _ in range(100):
        if os.path.isdir("i/runs") and os.listdir("i/runs"):
            break
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=30)[1]
    expect(process.returncode == 1 and "3 runs left" in said, f"interrupted: {process.returncode} {said}")


def check_wrong_input():
    write("bad.toml", DECK.replace("friction", "frction"))
    for words, remedy in [(("bad.toml",), "did you mean"), (("case.toml", "--exchange", "isned"), "isend"),
                          (("case.toml", "--vary", "time.step"), "--vary"), (("case.toml", "--ranks", "5000"), "ranks"),
                          (("case.toml", "--launcher", "no-such-launcher"), "--launcher"),
                          (("case.toml", "--vary", "time.step=1e-4,1"), "step"),
                          (("case.toml", "--barchan", "./nothing"), "no program"), (("case.toml", "--lab", "realtime=5"), "yes:no")]:
        fresh("w")
        done = run("sweep", *words, "--out", "w")
        expect(done.returncode == 2 and len(messages(done)) == 1 and remedy in done.stderr, f"sweep {words}: {done}")
        expect(not os.path.exists("w"), f"sweep {words} left a folder")
    done = run("sweep", "case.toml", "--out", ".")
    expect(done.returncode == 2 and "--out" in done.stderr, f"sweep into a folder of others: {done}")
    for words in (("table", "nowhere"), ("table", "l/runs"), ("compare", "s", "nowhere"), ("compare", "s:ranks=7", "s"),
                  ("table", "s", "--against", "exchange=get"), ("table", "s", "--csv", "--json")):
        done = run(*words)
        expect(done.returncode == 2 and len(messages(done)) == 1, f"{words}: {done}")


def check_tables():
    fresh("m")
    made("m", {("isend", n): 100.0 + n for n in range(1, 7)} | {("get", n): 1.05 * (100.0 + n) for n in range(1, 7)})
    table = json.loads(run("table", "m", "--json").stdout)
    expect([p["point"]["exchange"] for p in table["points"]] == ["isend", "get"], f"order: {table}")
    expect(abs(table["points"][1]["ratio"] - 1.05) < 1e-9 and abs(table["points"][0]["step_us"] - 103.5) < 1e-9, f"{table}")
    rows = run("table", "m", "--csv").stdout.splitlines()
    expect(len(rows) == 13 and rows[0].startswith("exchange,repetition,step_us"), f"csv: {rows}")
    expect(run("table", "m", "--md").stdout.count("\n| ") == 4, "Markdown")
    said = json.loads(run("compare", "m:exchange=isend", "m:exchange=get", "--json").stdout)[0]
    expect(said["paired"] and said["verdict"] == "5.0 % slower" and said["confidence"] > 0.95, f"compare: {said}")
    expect(said["differences"] == {"exchange": ["isend", "get"]}, f"compare: {said}")
    said = run("compare", "m:exchange=isend", "m:exchange=isend").stdout
    expect("no difference seen" in said and "Nothing differs" in said, f"compare with itself: {said}")
    made("n", {("isend", 1): 100.0}, state_digest="0000000000000000", machine={"host": "b"})
    said = run("compare", "m:exchange=isend", "n").stdout
    expect("state_digest" in said and "machine/host" in said, f"compare of other machines: {said}")
    made("n", {("get", 1): 100.0})
    expect("ended with" in run("table", "n").stdout, "digests that differ")


write("case.toml", DECK)
check_sweep()
check_launcher_and_failure()
check_interrupt()
check_wrong_input()
check_tables()
finish()
