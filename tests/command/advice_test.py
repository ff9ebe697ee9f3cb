"""Each remedy in a message about restarts is tried, with the checkpoint that the message names: it works."""
import re
import shutil

from _faults import CHECKPOINTS, checkpoints_of, expect_failure
from _helper import DECK, edited, expect, finish, fresh, messages, run, timed, write

LATTICE = DECK[DECK.index("[[particles]]"):DECK.index("[[wall]]")]
FLYING = LATTICE.replace("lo = [0.0, 0.2], hi = [4.0, 0.8]", "lo = [3.0, 0.85], hi = [3.2, 1.0]").replace(
    'material = "sand"', 'material = "sand"\nvelocity = [0.0, 9.0]')
OUT = "advice.out"


def go_on(*more, restart="auto", deck="advice.toml", out=OUT, ranks=1):
    return run("run", deck, "--out", out, "--quiet", "--restart", restart, *more, ranks=ranks)


def succeeds(name, done):
    expect(done.returncode == 0, f"{name}: status {done.returncode}, {done.stderr}")


def named_checkpoint(done):
    found = re.search(r"the last checkpoint is (\S+)", done.stderr)
    expect(found is not None, f"no checkpoint is named: {done.stderr}")
    return found.group(1) if found else "auto"


def failed_run(deck, *words, ranks=1, checkpoints=CHECKPOINTS):
    """@return the checkpoint that its error names"""
    write("advice.toml", deck + checkpoints)
    fresh(OUT)
    done = run("run", "advice.toml", "--out", OUT, "--quiet", ranks=ranks)
    expect_failure(str(words), done, *words)
    return named_checkpoint(done)


def check_departure(ranks):
    checkpoint = failed_run(edited(("[[wall]]", FLYING + "[[wall]]"), ("steps = 200", "steps = 2000")),
                            'domain.outside = "delete" takes particles out, also from a checkpoint on', ranks=ranks)
    again = go_on(restart=checkpoint)
    expect(again.returncode == 1, f"the same rule, the same end: {again.returncode}, {again.stderr}")
    succeeds("delete", go_on("--set", "domain.outside=delete", restart=checkpoint, ranks=3 - ranks))


def check_overlap():
    checkpoint = failed_run(edited(("steps = 200", "steps = 2500")) + "\n[limits]\noverlap_warning = 0.04\noverlap_error = 0.05\n",
                            "limits.overlap_error", "a higher limit lets the run continue, also from a checkpoint on")
    succeeds("a higher limit", go_on("--set", "limits.overlap_error=10", restart=checkpoint))


def saved_run(steps=200):
    write("advice.toml", DECK + CHECKPOINTS)
    fresh(OUT)
    succeeds("the run before", run("run", "advice.toml", "--out", OUT, "--quiet", "--steps", steps))
    return [f"{OUT}/checkpoints/{name}" for name in checkpoints_of(OUT)]


def refused(name, done, *words):
    expect(done.returncode == 2 and len(messages(done)) == 1, f"{name}: status {done.returncode}, {done.stderr}")
    for word in words:
        expect(word in done.stderr, f"{name}: no '{word}' in {done.stderr}")


def damage(checkpoint):
    with open(f"{checkpoint}/rank_00000.bin", "r+b") as file:
        file.seek(2000)
        byte = file.read(1)[0]
        file.seek(2000)
        file.write(bytes([byte ^ 16]))


def check_steps():
    """More --steps, or an earlier checkpoint."""
    saved = saved_run()
    refused("fewer steps", go_on("--steps", "120"), "of step 200", "more --steps or an earlier checkpoint")
    succeeds("an earlier checkpoint", go_on("--steps", "120", restart=saved[0]))
    saved_run()
    succeeds("more steps", go_on("--steps", "220"))


def check_damage():
    """Another checkpoint; where there is none: without --restart, with --force or another --out."""
    saved = saved_run()
    damage(saved[-1])
    refused("a damaged one", go_on("--steps", "220", restart=saved[-1]), "take another checkpoint")
    succeeds("another one", go_on("--steps", "220", restart=saved[0]))
    for checkpoint in (saved := saved_run()):
        damage(checkpoint)
    fresh("new.out")
    refused("none that is whole", go_on("--steps", "220"), "none of the checkpoints", "leave --restart out and give --force or another --out")
    succeeds("another --out", run("run", "advice.toml", "--out", "new.out", "--quiet"))
    succeeds("--force", run("run", "advice.toml", "--out", OUT, "--quiet", "--force"))


def check_none():
    """A checkpoint or a folder of them; or no --restart."""
    saved = saved_run()
    fresh("new.out", "empty")
    refused("no checkpoint", go_on(restart="empty", out="new.out"), "give a checkpoint or a folder of them; without --restart")
    for path in (saved[0], f"{saved[0]}/manifest.json", f"{OUT}/checkpoints", OUT):
        fresh("new.out")
        succeeds(f"from {path}", go_on("--steps", "220", restart=path, out="new.out"))
    fresh("new.out")
    succeeds("without --restart", run("run", "advice.toml", "--out", "new.out", "--quiet"))
    shutil.rmtree(f"{OUT}/checkpoints")
    refused("auto without checkpoints", go_on(), "already exists", "--force")
    succeeds("auto with --force", go_on("--force"))


def check_other_deck():
    """The deck and --set options of that run."""
    saved_run()
    refused("another deck", go_on("--steps", "220", "--set", "gravity=[0.0, -1.0]"), "differs in: gravity", "the deck and --set options of that run")
    succeeds("the deck of that run", go_on("--steps", "220"))


def check_damaged_series():
    """The damaged row removed. Until then nothing is: the run that has ended has still ended."""
    saved_run()
    with open(f"{OUT}/series.csv", encoding="utf-8") as file:
        rows = file.readlines()
    write(f"{OUT}/series.csv", "".join(rows[:20]) + "nonsense\n" + "".join(rows[20:]))
    refused("a damaged row", go_on("--steps", "220"), "series.csv:21", "remove the damaged row")
    with open(f"{OUT}/run.json", encoding="utf-8") as file:
        expect("state_digest" in file.read(), "a refused restart removed run.json")
    write(f"{OUT}/series.csv", "".join(rows))
    succeeds("the row removed", go_on("--steps", "220"))


def check_replay():
    saved_run()
    refused("replay", go_on("--exchange", "replay"), "replay a run from its start")
    fresh("new.out")
    succeeds("from its start", run("run", "advice.toml", "--out", "new.out", "--quiet", "--exchange", "replay", ranks=2))


for num_ranks in (1, 2):
    timed(check_departure, num_ranks)
for check in (check_overlap, check_steps, check_damage, check_none, check_other_deck, check_damaged_series, check_replay):
    timed(check)
finish()
