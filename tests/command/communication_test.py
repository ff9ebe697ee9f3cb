"""What the command tells about communication: probe, trace, step graph, replay, the choice of an exchange."""
import json
import os

from _helper import DECK, expect, finish, fresh, messages, run, write


def loaded(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def check_probe():
    done = run("probe", "--bytes", "64,4096", "--seconds", "0.002", "--json", ranks=2)
    expect(done.returncode == 0, f"probe: {done}")
    report = json.loads(done.stdout)
    expect(report["links"] == 1 and report["links_on_node"] == 1, f"links: {report}")
    found = {row["exchange"] for row in report["exchanges"]} | {o["exchange"] for o in report["obstacles"]}
    expect({"put-flag", "put-inband", "get", "shared", "pscw", "fence", "isend", "sendrecv"} <= found, f"probe has {found}")
    expect(all(row["half_round_trip_seconds"] > 0 for row in report["exchanges"]), "a half round trip of nothing")
    expect(all(row["half_round_trip_seconds"] <= row["half_round_trip_p99_seconds"] <= row["half_round_trip_most_seconds"]
               for row in report["exchanges"]), f"percentiles: {report['exchanges']}")
    done = run("probe", "--bytes", "64", "--repeat", "50", "--exchange", "isend,sendrecv", "--csv", ranks=2)
    rows = [line.split(",") for line in done.stdout.splitlines()]
    expect(done.returncode == 0 and [row[0] for row in rows[-2:]] == ["isend", "sendrecv"] and {len(row) for row in rows} == {9},
           f"probe --csv: {done}")
    done = run("probe", "--csv", "--json", ranks=2)
    expect(done.returncode == 2, f"probe in two formats: {done}")
    done = run("probe")
    expect(done.returncode == 2 and len(messages(done)) == 1, f"probe on one rank: {done}")
    done = run("probe", "--bytes", "3000000000", ranks=2)
    expect(done.returncode == 2 and len(messages(done)) == 1, f"probe of messages that no call moves: {done}")
    done = run("probe", "--exchange", "put-flog", ranks=2)
    expect(done.returncode == 2 and "put-flag" in done.stderr, f"probe of an unknown exchange: {done}")


def check_obstacles():
    """Without any component for windows, where the library is Open MPI; another one takes no notice."""
    os.environ["OMPI_MCA_osc"] = "^sm,rdma,pt2pt,ucx"
    small = ("--bytes", "64", "--seconds", "0.001")
    done = run("probe", *small, ranks=2)
    expect(done.returncode == 0, f"probe without windows: {done}")
    told = [line.strip() for line in done.stdout.splitlines() if "not here: " in line]
    done = run("probe", *small, "--json", ranks=2)
    obstacles = {o["exchange"]: o["reason"] for o in json.loads(done.stdout)["obstacles"]}
    expect(done.returncode == 0 and len(told) == len(set(obstacles.values())), f"probe tells {told} of {obstacles}")
    for name, reason in obstacles.items():
        lines = [line for line in told if name in line.split(": ")[1].split(", ") and line.endswith(reason)]
        expect(len(lines) == 1 and "--exchange" in reason, f"why {name} does not work: {told}")
    if "put-flag" in obstacles:
        expect({"put-inband", "get", "pscw", "fence"} <= set(obstacles), f"work without windows: {obstacles}")
        done = run("probe", *small, "--exchange", "get,isend,put-flag", ranks=2)
        expect(done.returncode == 2 and len(messages(done)) == 1, f"probe of exchanges that do not work: {done}")
        expect("get, put-flag: " + obstacles["get"] in done.stderr, f"what does not work: {done.stderr}")
        expect("isend" in done.stdout and "not here" not in done.stdout, f"what does: {done.stdout}")
    del os.environ["OMPI_MCA_osc"]


def check_trace_and_graph():
    fresh("traced.out", "step.dot")
    done = run("run", "case.toml", "--out", "traced.out", "--trace", "--graph", "step.dot", "--quiet", ranks=2)
    expect(done.returncode == 0, f"run with a trace: {done}")
    events = loaded("traced.out/trace.json")["traceEvents"]
    names = {event["name"] for event in events if event["ph"] == "X"}
    expect({"chunk", "send"} <= names, f"slices: {names}")
    sent = {event["id"]: event["ts"] for event in events if event["ph"] == "s"}
    noticed = {event["id"]: event["ts"] for event in events if event["ph"] == "f"}
    expect(len(noticed) > 100 and set(noticed) <= set(sent), "messages that nobody sent")
    expect(all(sent[name] <= ts for name, ts in noticed.items()), "messages noticed before they were sent")
    done = run("run", "case.toml", "--out", "traced.out", "--force", "--trace", "steps=20:24", "--quiet", ranks=2)
    kept = {event["args"]["step"] for event in loaded("traced.out/trace.json")["traceEvents"] if event["ph"] == "X"}
    expect(done.returncode == 0 and kept and kept <= set(range(20, 25)), f"steps of a trace: {sorted(kept)}, {done}")
    done = run("run", "case.toml", "--out", "traced.out", "--force", "--trace", "steps=24:20", "--quiet")
    expect(done.returncode == 2 and "no range of steps" in done.stderr, f"a range that ends before it begins: {done}")
    with open("step.dot", encoding="utf-8") as file:
        dot = file.read()
    expect(dot.count("{") == dot.count("}") and "r0_right0 -> r1_arrived0" in dot, "step.dot")


def check_replay():
    fresh("plain.out", "replay.out")
    run("run", "case.toml", "--out", "plain.out", "--quiet", ranks=2)
    done = run("run", "case.toml", "--out", "replay.out", "--exchange", "replay", "--record", "put-inband", ranks=2)
    expect(done.returncode == 0 and "Digest equal" in done.stdout, f"replay: {done}")
    plain, replay = loaded("plain.out/run.json"), loaded("replay.out/run.json")
    expect(plain["state_digest"] == replay["state_digest"], "a replay with another digest")
    expect(replay["exchange"] == "replay" and replay["transport"] == "memory", f"replay: {replay['transport']}")


def check_choice():
    run_json = loaded("plain.out/run.json")
    choice = run_json["exchange_choice"]
    expect(choice["name"] == run_json["exchange"] != "auto" and choice["name"] in choice["reason"], f"choice: {choice}")
    expect(len(choice["measured"]) >= 4, f"measured: {choice}")
    times = run_json["communication"]
    expect({"halo", "rebuild", "reductions"} <= set(times), f"communication: {times}")
    expect(0.0 < times["exposed_seconds"] <= times["in_flight_seconds"], f"communication: {times}")
    phases = sum(run_json["phases"].values())
    expect(0.0 < phases < 1.01 * run_json["loop_seconds"], f"phases: {run_json['phases']}")  # mean, slowest rank


write("case.toml", DECK)
check_probe()
check_obstacles()
check_trace_and_graph()
check_replay()
check_choice()
finish()
