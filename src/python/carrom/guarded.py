# SPDX-License-Identifier: BSD-3-Clause
"""Objects that are no data: a misspelled assignment is an error, and they cannot be pickled."""

from __future__ import annotations

import abc
import difflib
from typing import Any, NoReturn, TypeVar

_G = TypeVar("_G", bound="Guarded")


class Guarded(abc.ABC):
    """Lets only those attributes be set that a property sets, and those that begin with `_`."""

    @abc.abstractmethod
    def copy(self: _G) -> _G:
        """Return an independent object in the same state."""

    def __copy__(self: _G) -> _G:
        return self.copy()

    def __deepcopy__(self: _G, _: object) -> _G:
        return self.copy()

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            "a simulation cannot be pickled; send the path of a checkpoint, and begin with "
            "carrom.Simulation(path) there"
        )

    def __setattr__(self, name: str, value: Any) -> None:
        kind = getattr(type(self), name, None)
        if name.startswith("_") or (isinstance(kind, property) and kind.fset is not None):
            object.__setattr__(self, name, value)
            return
        settable = _settable(type(self))
        if kind is not None or name in vars(self):
            raise AttributeError(f"{name} cannot be set; {', '.join(settable)} can")
        near = difflib.get_close_matches(name, settable, 1)
        advice = f"; did you mean {near[0]}?" if near else f"; {', '.join(settable)} can be set"
        raise AttributeError(f"a simulation has no attribute {name}{advice}")


def _settable(kind: type) -> list[str]:
    properties = ((name, getattr(kind, name)) for name in dir(kind))
    return [name for name, of in properties if isinstance(of, property) and of.fset is not None]
