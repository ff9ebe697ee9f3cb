"""Callbacks of a simulation within run()."""
from __future__ import annotations

import os
from typing import Any, Callable, List, Optional, Tuple, Union

from . import _barchan


class Events:
    """Those of a Simulation."""
    _inside: _barchan.Simulation

    def on_step(self, every: int, call: Optional[Callable[[List[_barchan.Brick]], Any]]) -> None:
        """Calls `call(bricks)` before every step whose number is a multiple of `every`, with what owned() gives: forces
        that it writes act in this step.

        All callbacks are called between two steps, on the thread that called run(). What one raises on some rank ends the
        run on every rank with one RunEnded that has its words. Meanwhile owned(), set_loads(), clear_loads(), time,
        step, info and fields may be used, and nothing collective. Each replaces the former one; None ends it.
        Collective; a rank may give None while others do not.

        Raises:
            InputError: every is below 1, or not the same on every rank.
        """
        self._inside.on_step(every, call)

    def on_progress(self, every: int, call: Optional[Callable[[int, float], Any]]) -> None:
        """Calls `call(step, time)` on every rank after every step whose number is a multiple of `every`. See on_step()."""
        self._inside.on_progress(every, call)

    def on_note(self, call: Optional[Callable[[str, bool], Any]]) -> None:
        """Calls `call(text, is_warning)` instead of notes(), after every 16th step and before run() returns, on the rank
        that the note is of; rank 0 has those that all ranks know. See on_step()."""
        self._inside.on_note(call)

    def on_checkpoint(self, call: Optional[Callable[[int, str, str], Any]]) -> None:
        """Calls `call(step, folder, error)` on rank 0 when a checkpoint is complete (error is "") or could not be written
        (folder is ""), as on_note()."""
        self._inside.on_checkpoint(call)

    def on_bond_breaks(self, call: Optional[Callable[[List[Tuple[int, int, int]]], Any]]) -> None:
        """Calls `call([(step, id_a, id_b), ...])` on rank 0 with bonds of all ranks that broke, by step and ids, as
        on_note()."""
        self._inside.on_bond_breaks(call)

    def on_departure(self, call: Optional[Callable[[List[Tuple]], Any]]) -> None:
        """Calls `call([(step, id, position, velocity), ...])` on rank 0 when particles leave the domain, before they are
        removed or run() raises. Local."""
        self._inside.on_departure(call)

    def keep_checkpoints(self, folder: Union[str, os.PathLike], *, every_steps: int = 0, every_seconds: float = 0.0,
                         keep: int = 2) -> None:
        """From now on run() writes checkpoints behind the steps: every so many steps, every so many seconds (0: not by
        these), of which the newest `keep` stay. Collective."""
        self._inside.keep_checkpoints(os.fspath(folder), every_steps, every_seconds, keep)
