"""What `barchan run` wrote, as arrays."""
from __future__ import annotations

import json
import os
import pathlib
import re
from typing import Any, Dict, List, Union

import numpy as np

from . import _barchan

__all__ = ["Run", "read"]


class Run:
    """The folder of a run (docs/run_folder.md).

    Attributes:
        folder: its path.
        figures: run.json, a dict; empty while the run lasts.
        series: the columns of series.csv, by name.
        steps: those of which there are snapshots.
    """

    def __init__(self, folder: Union[str, os.PathLike]):
        self.folder = pathlib.Path(folder)
        if not self.folder.is_dir():
            raise FileNotFoundError(f"there is no folder {self.folder}: name one that `barchan run` wrote")
        series, figures = self.folder / "series.csv", self.folder / "run.json"
        if not series.exists() and not figures.exists():
            raise FileNotFoundError(f"{self.folder} is no folder of a run: it holds neither series.csv nor run.json")
        self.figures: Dict[str, Any] = json.loads(figures.read_text(encoding="utf-8")) if figures.exists() else {}
        self.series: Dict[str, np.ndarray] = _table(series) if series.exists() else {}
        names = (re.fullmatch(r"step_(\d+)\.pvtp", p.name) for p in (self.folder / "snapshots").glob("*.pvtp"))
        self.steps: List[int] = sorted(int(name.group(1)) for name in names if name)

    def frame(self):
        """The series as a pandas DataFrame (Debian: python3-pandas)."""
        import pandas
        return pandas.DataFrame(self.series)

    def snapshot(self, step: int = -1) -> Dict[str, np.ndarray]:
        """The particles at a step, in order of ids; -1: the last one.

        Returns:
            Arrays by name: id, type (from 0), radius, density, and position, velocity, omega of shape (particles, 3).
        """
        if not self.steps:
            raise LookupError(f"{self.folder} has no snapshots")
        step = self.steps[-1] if step == -1 else step
        if step not in self.steps:
            raise LookupError(f"there is no snapshot of step {step}: there are {_some(self.steps)}")
        columns = _barchan.read_particles(str(self.folder / "snapshots" / f"step_{step:09}.pvtp"))
        order = np.argsort(columns["id"], kind="stable")
        return {name: values[order] for name, values in columns.items()}

    def __repr__(self) -> str:
        rows = len(next(iter(self.series.values()), ()))
        return f"<barchan run {str(self.folder)!r}: {rows} rows, {len(self.steps)} snapshots>"


def read(folder: Union[str, os.PathLike]) -> Run:
    """Reads the folder of a run: `barchan.read("soil_duct.out").series["kinetic_energy"]`."""
    return Run(folder)


def _table(path: pathlib.Path) -> Dict[str, np.ndarray]:
    with open(path, encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        rows = np.loadtxt(file, delimiter=",", ndmin=2, dtype=float)
    rows = rows.reshape(-1, len(names))
    return {name: _whole(rows[:, k]) for k, name in enumerate(names)}


def _whole(column: np.ndarray) -> np.ndarray:
    """Counts as integers."""
    is_whole = np.all(np.isfinite(column)) and np.all(column == np.rint(column)) and np.all(np.abs(column) < 2**53)
    return column.astype(np.int64) if len(column) and is_whole else column


def _some(steps) -> str:
    return ", ".join(map(str, steps)) if len(steps) < 9 else f"{steps[0]}, {steps[1]}, ..., {steps[-1]}"
