"""What one process does alone works where MPI cannot start, and among ranks is said once."""
import os

from _helper import DECK, edited, expect, finish, fresh, messages, run, write

BROKEN = {"OMPI_MCA_pml": "none_such", "UCX_TLS": "none_such", "FI_PROVIDER": "none_such"}
LOCAL = [["check", "case.toml"], ["info", "case.toml"], ["convert", "a.csv", "b.vtp", "--force"],
         ["--help"], ["--version"], ["run", "--help"]]


def check_broken():
    os.environ.update(BROKEN)
    ends = run("run", "case.toml", "--steps", "1", "--quiet", "--out", "broken.out").returncode == 0
    for arguments in LOCAL:
        done = run(*arguments)
        expect(done.returncode == 0 and done.stdout and not done.stderr,
               f"{arguments} without MPI: {done}")
    done = run("check", "bad.toml")
    expect(done.returncode == 2 and len(messages(done)) == 1, f"check of a bad deck without MPI: {done}")
    for name in BROKEN:
        del os.environ[name]
    if ends:
        print("this MPI starts all the same, so nothing is shown")


def check_ranks():
    for arguments in LOCAL:
        alone, among = run(*arguments), run(*arguments, ranks=2)
        expect(among.returncode == 0 and among.stdout == alone.stdout, f"{arguments} on two ranks: {among}")
    done = run("check", "bad.toml", ranks=2)
    expect(done.returncode == 2 and len(messages(done)) == 1, f"check of a bad deck on two ranks: {done}")


write("case.toml", DECK)
write("bad.toml", edited(("density = 1000.0", "density = -1.0")))
write("a.csv", "id,type,radius,density,x,y,z\n1,1,0.1,1000,0,0,0\n")
fresh("broken.out")
check_broken()
check_ranks()
finish()
