# SPDX-License-Identifier: BSD-3-Clause
"""Completion in IPython and Jupyter, which evaluate attributes of trusted classes alone.

IPython completes `run.tables["` only if it may read `run.tables`, a property. Its list of classes
whose properties it reads can be added to, and the properties of these classes change nothing.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterable
from typing import Any


def trust(attributes_of: Iterable[type], items_of: Iterable[type]) -> None:
    """Let IPython read attributes of some classes and items of others as it completes names.

    Does nothing outside of IPython, and in versions before 8.11, which evaluate nothing.
    """
    if "IPython" not in sys.modules:
        return
    try:
        evaluation: Any = importlib.import_module("IPython.core.guarded_eval")
        policy = evaluation.EVALUATION_POLICIES["limited"]
    except (ImportError, LookupError, AttributeError):
        return
    policy.allowed_getattr = policy.allowed_getattr | set(attributes_of)
    policy.allowed_getitem = policy.allowed_getitem | set(items_of)
