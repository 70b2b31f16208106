# SPDX-License-Identifier: BSD-3-Clause
"""Scenes as Python sees them: dictionaries that become TOML, and keys that replace keys."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Union

import numpy as np

from carrom.errors import CarromError, FileError
from carrom.plain import read_text

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

SceneLike = Union[Mapping[str, Any], str, "os.PathLike[str]"]
"""A scene: a dictionary, the path of a file, or TOML text (any string with a line break)."""

SCENE_FILES = ("scene.toml", "scene.in")
"""A run keeps a copy of its scene under one of these names."""

FILE_KEYS = ("discs.file", "discs.from", "effects.field.file")
"""Keys that name a file by its path from the scene's own file."""

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_REMARK = "# --set "
_DEEPEST = 64  # nested tables and lists; the program accepts at most 256
_LONG_KEY = re.compile(rf"(?<![\w-])(?:[\w-]+\s*\.\s*){{{_DEEPEST}}}")
_NESTING = (list, tuple, Mapping)
_TOO_DEEP = f"has tables or lists nested more than {_DEEPEST} deep, or in themselves"


def _check_depth(value: Any, kinds: Any = Mapping) -> None:
    """Refuse a scene whose values of these kinds are in themselves, or deeper than in any scene.

    Raises:
        ValueError: they are
    """
    level = [value]
    for _ in range(_DEEPEST):
        inner: list[Any] = []
        seen: set[int] = set()
        for item in level:
            if isinstance(item, Mapping):
                words = [key for key in item if isinstance(key, str)]
                if any(key.count(".") + key.count("__") >= _DEEPEST for key in words):
                    raise ValueError(f"a key of the scene {_TOO_DEEP}")
                parts: Iterable[Any] = item.values()
            else:
                parts = item
            for part in parts:
                if isinstance(part, kinds) and id(part) not in seen:
                    seen.add(id(part))
                    inner.append(part)
        if not inner:
            return
        level = inner
    raise ValueError(f"the scene {_TOO_DEEP}")


def toml_value(value: Any) -> str:
    """Write a value as TOML. Floats keep every bit.

    Raises:
        TypeError: TOML has no such value, for example None
    """
    if isinstance(value, _NESTING):
        _check_depth(value, _NESTING)
    return _toml_value(value)


def _toml_value(value: Any) -> str:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return _quoted(os.fspath(value))
    if isinstance(value, Mapping):
        words = [f"{_key(key)} = {_toml_value(item)}" for key, item in value.items()]
        return "{" + ", ".join(words) + "}"
    if isinstance(value, (list, tuple, range)):
        return "[" + ", ".join(_toml_value(item) for item in value) + "]"
    raise TypeError(f"a scene cannot have {value!r}: TOML has no {type(value).__name__}")


def to_toml(scene: Mapping[str, Any]) -> str:
    """Write a scene as TOML, a table for each nested dictionary. Keys with dots are nested too."""
    return "\n".join(_table_lines((), nested(scene))) + "\n"


def keys_of_lines(text: str) -> list[str]:
    """Return the key, with dots, that stands on each line of what `to_toml` has written."""
    keys: list[str] = []
    table = ""
    for line in text.splitlines():
        if line.startswith("["):
            table = line.strip("[]")
            keys.append(table)
        else:
            keys.append(".".join(filter(None, (table, line.partition(" = ")[0]))))
    return keys


def _table_lines(path: tuple[str, ...], table: Mapping[str, Any]) -> list[str]:
    plain = {key: value for key, value in table.items() if not isinstance(value, Mapping)}
    tables = {key: value for key, value in table.items() if isinstance(value, Mapping)}
    lines = []
    if path and (plain or not tables):
        lines.append("[" + ".".join(_key(word) for word in path) + "]")
    for key, value in plain.items():
        try:
            lines.append(f"{_key(key)} = {toml_value(value)}")
        except TypeError as error:
            raise TypeError(f"{'.'.join(map(str, (*path, key)))}: {error}") from None
    for key, value in tables.items():
        lines += _table_lines((*path, key), value)
    return lines


def _key(word: object) -> str:
    if not isinstance(word, str):
        raise TypeError(f"keys of a scene are strings, not {word!r}")
    return word if _BARE_KEY.fullmatch(word) else _quoted(word)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def flattened(overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Return overrides by the program's keys.

    `{"time": {"steps": 5}}`, `{"time.steps": 5}` and `{"time__steps": 5}` all give
    `{"time.steps": 5}`.
    """
    _check_depth(overrides)
    return _flattened(overrides, "")


def _flattened(overrides: Mapping[str, Any], above: str) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in overrides.items():
        key = above + str(name).replace("__", ".")
        if isinstance(value, Mapping):
            flat |= _flattened(value, key + ".")
        else:
            flat[key] = value
    return flat


def nested(scene: Mapping[str, Any]) -> dict[str, Any]:
    """Return a copy of a scene in which each dot of a key has become a table."""
    _check_depth(scene)
    return _nested(scene)


def _nested(scene: Mapping[str, Any]) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for name, value in scene.items():
        _put(result, name, _nested(value) if isinstance(value, Mapping) else value)
    return result


def _put(scene: dict[str, Any], key: str, value: Any) -> None:
    """Set a key like `time.steps`. Tables are merged."""
    first, _, rest = key.partition(".") if isinstance(key, str) else (key, "", "")
    if rest:
        _put(_subtable(scene, first, key), rest, value)
    elif isinstance(value, Mapping):
        table = _subtable(scene, first, key)
        for name, item in value.items():
            _put(table, name, item)
    else:
        scene[first] = value


def _subtable(scene: dict[str, Any], name: str, key: str) -> dict[str, Any]:
    table = scene.setdefault(name, {})
    if not isinstance(table, dict):
        raise TypeError(f"{key}: {name} is a value and cannot have keys")
    return table


def merged(scene: Mapping[str, Any], overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Return a copy of a scene with some keys set."""
    result = nested(scene)
    for key, value in flattened(overrides).items():
        _put(result, key, value)
    return result


def read_scene(scene: SceneLike) -> dict[str, Any]:
    """Return a scene as a dictionary, with what its remarks `# --set key=value` set.

    Legacy text (`FILE.in`) has no keys: the dictionary is empty but for what remarks set.
    """
    if isinstance(scene, Mapping):
        return nested(scene)
    if isinstance(scene, str) and is_text(scene):
        text, name = scene, "the scene's text"
    else:
        text, name = _file_text(Path(scene))
    remarks = [line.removeprefix(_REMARK) for line in text.splitlines() if line.startswith(_REMARK)]
    return parsed(text, name, remarks)


def parsed(text: str, name: str, overrides: Iterable[str]) -> dict[str, Any]:
    """Read a scene's text, with overrides `key=value`. The name tells legacy text from TOML."""
    try:
        known = {} if name.endswith(".in") or name == "-" else _loaded(text)
    except tomllib.TOMLDecodeError as error:
        raise FileError(f"{name}: {error}") from None
    except RecursionError:
        raise FileError(f"{name}: {_TOO_DEEP}") from None
    pairs = [line.partition("=") for line in overrides]
    return merged(known, {key: _value_of(word) for key, _, word in pairs})


def _loaded(text: str) -> dict[str, Any]:
    """Read TOML. The time that a key takes grows with the square of its dots.

    Raises:
        RecursionError: something is nested too deeply
    """
    if _LONG_KEY.search(text):
        raise RecursionError
    return tomllib.loads(text)


def is_text(scene: object) -> bool:
    """Whether a scene is TOML text: a string with a line break. Any other string is a path."""
    return isinstance(scene, str) and "\n" in scene


def _file_text(path: Path) -> tuple[str, str]:
    try:
        return read_text(path), str(path)
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{path}: cannot be read: {error}") from None


def _value_of(word: str) -> Any:
    """Read the value of `--set key=value`, whose words need no quotes."""
    try:
        return _loaded(f"value = {word}")["value"]
    except (tomllib.TOMLDecodeError, RecursionError):
        return word


@dataclass
class SceneFile:
    """A scene as the command line has it.

    Attributes:
        path: the file that the program reads
        overrides: `key=value` for `--set`
        text: the TOML that was written for a dictionary or a text; else None
    """

    path: Path
    overrides: list[str]
    text: str | None = None


@contextlib.contextmanager
def scene_file(scene: SceneLike, overrides: Mapping[str, Any], folder: Path) -> Iterator[SceneFile]:
    """Give the program a file to read: `input.toml` in the folder, as long as the context lasts.

    There all nodes of a cluster see it, and the name that the program stores is no random one.
    A file of that name stays; the scene's is then `input-2.toml`.
    """
    words = set_words(overrides)
    if not isinstance(scene, (Mapping, str, os.PathLike)):
        raise TypeError(f"a scene is a dictionary, a path or TOML text, not {scene!r}")
    if not isinstance(scene, Mapping) and not is_text(scene):
        yield SceneFile(Path(scene), words)
        return
    if isinstance(scene, Mapping):
        text = to_toml(with_absolute_files(merged(scene, overrides)))
        words = []
    else:
        text = str(scene)
        words = _with_absolute_files(text, words)
    path = _new_file(folder, text)
    try:
        yield SceneFile(path, words, text)
    finally:
        path.unlink(missing_ok=True)


def _new_file(folder: Path, text: str) -> Path:
    """Write a text to a new file. One of the same name may be the user's, or another run's."""
    content = text.encode()
    for number in itertools.count(1):
        path = folder / ("input.toml" if number == 1 else f"input-{number}.toml")
        with contextlib.suppress(FileExistsError), open(path, "xb") as file:
            file.write(content)
            break
    return path


def set_words(overrides: Mapping[str, Any]) -> list[str]:
    """Return overrides as `key=value`, for `--set`."""
    words = []
    for key, value in flattened(overrides).items():
        try:
            words.append(f"{key}={toml_value(value)}")
        except TypeError as error:
            raise TypeError(f"{key}: {error}") from None
    return words


def with_absolute_files(scene: dict[str, Any], beside: Path = Path()) -> dict[str, Any]:
    """Name the files of `FILE_KEYS` in full: the program looks beside the scene that it is given.

    Paths of a dictionary or a text begin in the working folder, which is `beside` by default.
    """
    for key, file in _files_of(scene).items():
        _put(scene, key, str((beside / file).absolute()))
    return scene


def _files_of(scene: Mapping[str, Any]) -> dict[str, str | os.PathLike[str]]:
    """Return the files of `FILE_KEYS` that a nested scene names."""
    found = flattened(scene)
    files = {key: found.get(key) for key in FILE_KEYS}
    return {
        key: file for key, file in files.items() if isinstance(file, (str, os.PathLike)) and file
    }


def _with_absolute_files(text: str, words: list[str]) -> list[str]:
    """Return settings for a scene's text that name its files in full."""
    try:
        files = _files_of(parsed(text, "scene.toml", words))
    except (CarromError, TypeError, ValueError):
        return words  # the program reports it
    others = [word for word in words if word.partition("=")[0] not in files]
    return others + [f"{key}={toml_value(Path(file).absolute())}" for key, file in files.items()]
