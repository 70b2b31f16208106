# SPDX-License-Identifier: BSD-3-Clause
"""`Simulation`: a scene in this process, step by step, with its discs as arrays.

The bits are those of `carrom run`, for any number of threads, however steps are divided into calls.
What it gives are copies: they cannot be written to, so that `sim.positions[0] = ...` is an error.
"""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, Union, overload

import numpy as np
import numpy.typing as npt

from carrom import display
from carrom.actions import Actions
from carrom.checkpoints import Checkpoint
from carrom.core_module import load
from carrom.destinations import refuse_owned
from carrom.disc_arrays import Array
from carrom.errors import CarromError
from carrom.given_arrays import agreed, checked, locked
from carrom.guarded import Guarded
from carrom.held_core import Closable, HeldCore
from carrom.launching import CarromWarning, ProgressLike
from carrom.live_report import Changes, facts_to_show, report_of
from carrom.live_results import Averages, LiveTables
from carrom.memory_frame import LocalDiscs, MemoryFrame
from carrom.progress import progress_display, show_end
from carrom.scene import SceneLike
from carrom.simulation_source import add_up, core_of
from carrom.stepping import advance, end_of_run

if TYPE_CHECKING:
    from carrom import _core

_UNITS = {"positions": "lengths", "velocities": "lengths per step", "spins": "radians per step"}
"""What can be changed, and its unit."""

Action = Callable[["Simulation"], object]
_A = TypeVar("_A", bound=Action)


class Simulation(Closable, Guarded):
    """A scene as it moves forward in time, in this process.

    `sim.run(100)` steps, `sim.positions` are arrays, and `sim.velocities = -sim.velocities` turns
    all discs round; they retrace their paths for some 25 collisions of each disc, until roundings
    have grown too far. All calls come from the thread that made the first simulation.
    `with carrom.Simulation(scene) as sim:` closes it at the end, as `sim.close()` does.

    Attributes:
        method: "event-driven" or "time-stepped"
        corner: (2,) the place of its lower left corner: (0, 0), unless the scene has `box.origin`
        periodic: whether the sides along x and along y are periodic
        masses: (N,) in the scene's unit; 1 unless the scene gives masses
        species: (N,) from 0, in the order of ids
        last_step: `time.steps` of the scene; `run` goes no further
    """

    def __init__(
        self,
        scene: Union[SceneLike, Checkpoint],  # noqa: UP007
        threads: int | None = None,
        *,
        comm: Any = None,
        **overrides: Any,
    ) -> None:
        """Begin with a scene at step 0, or go on from a checkpoint.

        Args:
            scene: a dictionary, TOML text, the path of a scene, or a checkpoint: its path (`.h5`),
                the folder of a run, or a `carrom.Checkpoint`
            threads: threads; None: OMP_NUM_THREADS, else the cores of this process
            comm: a communicator of mpi4py; all of its ranks make the same calls. None: all ranks
                that the process was started with, usually one
            **overrides: keys of the scene: `time__steps=50`; of a checkpoint those that may change

        Raises:
            SceneError: the scene or the checkpoint is wrong; the message has all problems
            MissingPackageError: the extension is not there
        """
        self._comm = comm
        self._begin(core_of(scene, threads, comm, overrides))

    def _begin(self, made: _core.Core) -> None:
        self._held = HeldCore(made, load())
        self._first_step = made.step
        self._actions: Actions[Simulation] = Actions()
        self._changes = Changes()
        self._is_running = False
        facts, (radii, masses, species) = made.facts, map(locked, made.kinds)
        vars(self).update(
            method=facts["method"],
            corner=locked(np.array(facts["corner"])),
            periodic=facts["periodic"],
            last_step=int(facts["steps"]),
            n_discs=int(facts["n_discs"]),
            _radii=None if facts["exchanges_radii"] else radii,
            masses=masses,
            species=species,
        )
        self._warn()

    def _warn(self) -> None:
        for line in self._core.taken_lines():
            if line.startswith("warning: "):
                warnings.warn(line.removeprefix("warning: ").strip(), CarromWarning, stacklevel=4)

    method: str
    corner: Array
    periodic: tuple[bool, bool]
    _radii: Array | None
    masses: Array
    species: Array
    last_step: int
    n_discs: int

    # Steps

    @property
    def step(self) -> int:
        """Steps since the scene's start."""
        return int(self._core.step)

    @property
    def box(self) -> Array:
        """Edges (2,) along x and y, lengths; `effects.barostat.axes = "each"` changes them."""
        return locked(np.array(self._core.box))

    def run(self, steps: int, progress: ProgressLike = None) -> None:
        """Move forward by some steps, and call the actions that are due on the way.

        A condition of `time.stop` ends the run before, at its step. Other threads of Python run
        meanwhile. Ctrl-C stops at the end of a step and leaves the
        simulation usable (on several ranks it ends the launcher). An error in an action stops the
        run at its step, with the action's traceback.

        Args:
            steps: how many; 0 or more
            progress: True or False; None shows a bar in notebooks and a line on terminals for runs
                of more than some seconds. Or a function of the step and the last step

        Raises:
            SceneError: `time.steps` comes before
            TypeError: `steps` is no whole number

        On several ranks all of them raise the error of the first rank that has one.
        """
        if self._is_running:
            raise CarromError("an action cannot run the simulation that calls it; take sim.copy()")
        end = end_of_run(self._core, steps, self.last_step)
        self._is_running = True
        try:
            with progress_display(progress) as show:
                advance(self._core, self._actions, self, end, show)
                if self.step == end:
                    show_end(progress, end)
        finally:
            self._is_running = False
        self._warn()

    @overload
    def every(self, interval: int) -> Callable[[_A], _A]: ...
    @overload
    def every(self, interval: int, action: _A) -> _A: ...
    def every(self, interval: int, action: Any = None) -> Any:
        """Call `action(sim)` at the end of each step that is a multiple of `interval`.

        Actions of one step are called in the order in which they were added. Without `action` it
        is a decorator. Returns the action, for `forget`.
        """
        self._held.use()
        if action is None:
            return lambda function: self.every(interval, function)
        self._actions.add(interval, action)
        return action

    def forget(self, action: Action) -> None:
        """Call an action no more."""
        self._actions.forget(action)

    # Discs

    @property
    def positions(self) -> Array:
        """Positions (N, 2), lengths, in the order of ids; between periodic sides in the box.

        Can be set between steps: see `change`.
        """
        return self._gathered(self._core.positions)

    @positions.setter
    def positions(self, values: npt.ArrayLike) -> None:
        self._set("positions", values)

    @property
    def radii(self) -> Array:
        """Radii (N,), lengths: of the scene's start, or of the step under `effects.swap`."""
        return locked(self._core.kinds[0]) if self._radii is None else self._radii

    @property
    def velocities(self) -> Array:
        """Velocities (N, 2), lengths per step. Can be set between steps: see `change`."""
        return self._gathered(self._core.velocities)

    @velocities.setter
    def velocities(self, values: npt.ArrayLike) -> None:
        self._set("velocities", values)

    @property
    def spins(self) -> Array:
        """Angular velocities (N,) of rough discs, radians per step; else 0. Can be set."""
        return self._gathered(self._core.spins)

    @spins.setter
    def spins(self, values: npt.ArrayLike) -> None:
        self._set("spins", values)

    @property
    def directions(self) -> Array:
        """Directions (N,) of active discs, radians from the x axis, counterclockwise; else 0."""
        return self._gathered(self._core.directions)

    @property
    def images(self) -> Array:
        """Box lengths (N, 2), whole numbers, that discs have flown on through periodic sides.

        `positions + images * box` goes on without jumps. They count from the scene's start, or
        from a checkpoint that has none, as those of `carrom run` without images in a trajectory.

        Raises:
            SceneError: sides are sheared, so that images move
        """
        return self._gathered(self._core.images)

    @property
    def wall_collisions(self) -> Array:
        """Collisions with walls and obstacles since the scene's start, (N,) integers."""
        return self._gathered(self._core.collisions)[:, 0]

    @property
    def pair_collisions(self) -> Array:
        """Collisions with other discs since the scene's start, (N,) integers."""
        return self._gathered(self._core.collisions)[:, 1]

    def change(
        self,
        *,
        positions: npt.ArrayLike | None = None,
        velocities: npt.ArrayLike | None = None,
        spins: npt.ArrayLike | None = None,
    ) -> None:
        """Give discs other positions, velocities or spins between two steps.

        What follows is a function of these numbers and the step alone. Discs whose numbers are as
        they were keep all of their bits. Averages begin anew (`averages.first_step` says where);
        where positions have changed, tables do so, too. It takes as long as making the simulation.

        Args:
            positions: (N, 2), lengths
            velocities: (N, 2), lengths per step
            spins: (N,), radians per step

        Raises:
            SceneError: a number is not finite, a disc is outside of the box or in an obstacle, or
                discs would overlap; nothing is changed then
            ValueError: an array has another shape, a unit or masked elements
            TypeError: an array has no real numbers

        On several ranks all of them raise the error of the first rank that has one.
        """
        given = {"positions": positions, "velocities": velocities, "spins": spins}
        self._change({name: values for name, values in given.items() if values is not None})

    def _set(self, name: str, values: npt.ArrayLike) -> None:
        self._change({name: values})

    def _change(self, given: dict[str, npt.ArrayLike]) -> None:
        core = self._core
        arrays: dict[str, Array | None] = dict.fromkeys(_UNITS)
        with agreed(core):
            for name, values in given.items():
                shape = (self.n_discs,) if name == "spins" else (self.n_discs, 2)
                arrays[name] = checked(name, _UNITS[name], values, shape)
        core.change(**arrays)
        self._changes.note(given, self.step)

    @property
    def local(self) -> LocalDiscs:
        """The discs of this rank. Other ranks need not make the call."""
        core, ids = self._core, self._core.ids
        return LocalDiscs(ids, core.positions[ids], core.velocities[ids], core.spins[ids])

    def _gathered(self, mine: Array) -> Array:
        """Return the numbers of all ranks' discs; those of others are 0 here."""
        if self._core.ranks > 1:
            add_up(mine, self._comm)
        return locked(mine)

    @property
    def frame(self) -> MemoryFrame:
        """The discs now as a `carrom.Frame`: for pandas, freud, OVITO, `carrom.plot.frame` ..."""
        return MemoryFrame(self)

    # Sums, averages and tables

    @property
    def totals(self) -> dict[str, Any]:
        """Sums over all discs: energies, momentum, collisions, overlaps, the state hash.

        Costs about as much as a step, because pairs that overlap are searched for.
        """
        totals: dict[str, Any] = self._core.totals
        return totals

    @property
    def energy(self) -> float:
        """Kinetic and rotational energy, and potential energy under gravity."""
        totals = self.totals
        names = ("kinetic_energy", "rotational_energy", "potential_energy")
        return math.fsum(float(totals[name]) for name in names)

    @property
    def collisions(self) -> int:
        """Collisions of pairs since the scene's start."""
        return int(self.totals["pair_collisions"])

    @property
    def state_hash(self) -> str:
        """The hash over the states of all discs, as the summary of `carrom run` has it."""
        return str(self.totals["state_hash"])

    @property
    def averages(self) -> Averages:
        """Averages since the start, or since discs were changed, each with its error."""
        return Averages(self._core.averages)

    def restart_averages(self) -> None:
        """Forget what has been averaged so far, for example before equilibrium."""
        self._core.restart_averages()

    @property
    def tables(self) -> LiveTables:
        """What `output.measurements` of the scene asks for, as sampled so far."""
        return LiveTables(self._core.tables)

    @property
    def report(self) -> dict[str, Any]:
        """Sums and averages by the keys of `report.json`, as far as no machine is in them.

        `changes` has how often positions, velocities or spins were set, and at which steps first
        and last; `averages["from_step"]` says where averages have begun anew.
        """
        core = self._core
        steps = self._first_step, self.step
        return report_of(core.facts, core.totals, core.averages, steps, self._changes)

    # Branches

    def checkpoint(self, path: str | os.PathLike[str]) -> Path:
        """Write the state as a whole file or not at all, and return its path.

        `carrom.Simulation(path)` and `carrom run --restart` go on from it with the same bits.
        On several ranks all of them raise the error of the first rank that has one.
        """
        with agreed(self._core):
            refuse_owned(path, begins=(b"\x89HDF",))
        self._core.write_checkpoint(os.fspath(path))
        return Path(path)

    def copy(self) -> Simulation:
        """Return an independent simulation of the same state, without actions, in memory."""
        twin = object.__new__(Simulation)
        twin._comm = self._comm
        twin._begin(self._core.copy())
        twin._first_step = self._first_step
        twin._changes = Changes(self._changes.as_dict())
        return twin

    def __repr__(self) -> str:
        state = "closed" if self._held.is_closed else f"step {self.step} of {self.last_step}"
        return f"<Simulation of {self.n_discs} discs, {state}>"

    def _repr_html_(self) -> str:
        if self._held.is_closed:
            return display.facts("simulation", {"discs": self.n_discs, "state": "closed"})
        return display.facts("simulation", facts_to_show(self)) + display.picture(self.frame)
