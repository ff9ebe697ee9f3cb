"""What callers give, as barchan takes it."""
from __future__ import annotations

from typing import Any, List, Sequence, Union

import numpy as np

from . import _barchan

Vector = Union[Sequence[float], np.ndarray]


def handle_of(comm: Any) -> int:
    if not _barchan.is_mpi_running():
        if comm is not None and not isinstance(comm, int):
            raise ValueError("MPI does not run: import mpi4py.MPI, which starts it")
        _barchan.start_mpi()
    if comm is None:
        return _barchan.world()
    if isinstance(comm, int):
        return comm
    if hasattr(comm, "py2f"):
        return comm.py2f()
    raise TypeError(f"comm is a communicator of mpi4py, its Fortran handle, or None, not {comm!r}")


def field(name: str) -> _barchan.Field:
    fields = _barchan.Field.__members__
    if name not in fields:
        raise ValueError(f"there is no field {name!r}: {', '.join(fields)}")
    return fields[name]


def whole(values: Any, what: str) -> np.ndarray:
    """(n) whole numbers from whatever numbers."""
    given = np.asarray(values).ravel()
    numbers = given.astype(np.int64)
    if given.dtype.kind == "f" and not np.array_equal(numbers, given):
        raise ValueError(f"{what} are whole numbers, not {given[numbers != given][0]:g}")
    return numbers


def three(v: Vector) -> List[float]:
    v = np.asarray(v, dtype=float).ravel()
    if len(v) not in (2, 3):
        raise ValueError(f"a vector has 2 or 3 components, not {len(v)}")
    return [float(v[0]), float(v[1]), float(v[2]) if len(v) == 3 else 0.0]


def vectors(values: Any, n: int, what: str) -> np.ndarray:
    """(n, 3) from that, from (n, 2) with z = 0, or from one vector or number for all."""
    values = np.asarray(values, dtype=float)
    if values.ndim == 0 or values.shape in ((2,), (3,)):
        if values.ndim == 0 and values != 0.0:
            raise ValueError(f"{what}: a number for a vector")
        values = np.broadcast_to(values, (n, 3 if values.ndim == 0 else len(values)))
    if values.shape not in ((n, 2), (n, 3)):
        raise ValueError(f"{what} of shape {values.shape} for {n} particles: ({n}, 3), in 2D also ({n}, 2)")
    rows = np.zeros((n, 3))
    rows[:, :values.shape[1]] = values
    return rows


def turns(values: Any, n: int, what: str) -> np.ndarray:
    """(n, 3) from that, or from (n): about z."""
    values = np.asarray(values, dtype=float)
    if values.ndim == 0 or values.shape in ((n,), (n, 1)):
        rows = np.zeros((n, 3))
        rows[:, 2] = values.reshape(-1) if values.ndim else values
        return rows
    return vectors(values, n, what)
