"""The scripts of examples/cluster do what they say, with a launcher that starts one rank."""
import os
import pathlib
import shutil
import subprocess

from _helper import COMMAND, expect, finish, write

TREE = pathlib.Path(os.environ["BARCHAN_SOURCE"])
EXAMPLES = TREE / "examples"


def prepare():
    """A barchan that does few steps, an srun that runs its words, and the files that the scripts want beside them."""
    os.makedirs("bin", exist_ok=True)
    write("bin/srun", '#!/bin/bash\nexec "$@"\n')
    write("bin/barchan", f'#!/bin/bash\n[[ $1 != run ]] || set -- "$@" --steps 40\nexec "{COMMAND}" "$@"\n')
    for name in ("srun", "barchan"):
        os.chmod(f"bin/{name}", 0o755)
    for name in ("heap.toml", "plot_series.py"):
        shutil.copy(EXAMPLES / name, name)


def start(words, **extra):
    environment = {**os.environ, "PATH": f"{os.path.abspath('bin')}:{os.environ['PATH']}", **extra}
    return subprocess.run(words, env=environment, capture_output=True, text=True, timeout=120)


def check_array():
    shutil.rmtree("study", ignore_errors=True)
    ask = ["bash", str(EXAMPLES / "cluster" / "study.slurm")]
    for _ in range(2):  # the second time it finds that all is done
        done = start(ask, SLURM_ARRAY_TASK_ID="6", SLURM_CPUS_PER_TASK="1")
        expect(done.returncode == 0, f"a job of the array: {done}")
    expect(os.path.exists("study/friction=0.5,seed=2/run.json"), f"the seventh job: {os.listdir('study')}")


def check_snakemake():
    if shutil.which("snakemake") is None:
        return
    shutil.rmtree("study", ignore_errors=True)
    done = start(["snakemake", "--cores", "2", "--snakefile", str(EXAMPLES / "cluster" / "Snakefile"), "--config", "frictions=[0.2]"])
    expect(done.returncode == 0 and os.path.exists("study/friction_0.2.svg"), f"Snakemake: {done.stderr[-2000:]}")


prepare()
check_array()
check_snakemake()
finish()
