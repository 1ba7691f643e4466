"""Numerical schemes for strings against obstacles, compared by speed and accuracy on the same
scenes. SI units."""

from os import PathLike
from typing import Any, Mapping, Sequence, Union

import numpy as np
from numpy.typing import NDArray

_Path = Union[str, PathLike[str]]
_Value = Union[bool, int, float, _Path, Sequence["_Value"]]
# Its keys are columns; numbers as numbers, None where nothing is known. Of a cell, row["errors"]
# has {tap: {measure: {"value", "floor", "certificate", "in_model", "certificate_in_model"}}}.
_Row = dict[str, Any]

class Rows(list[_Row]):
    """What compare and judge give: rows that report() can write to a folder."""

__version__: str

class Refusal(RuntimeError):
    """The scheme cannot represent the scene; the sentence says what is missing."""

class SceneError(ValueError):
    """A scene that is none: file, line, key and what was expected."""

class UsageError(ValueError):
    """A name or a number that cannot be; the sentence says what was expected."""

class Scene:
    """What vibrates. A value: set() gives another."""

    def set(self, key: str, value: _Value) -> Scene: ...
    @property
    def name(self) -> str: ...
    @property
    def duration(self) -> float: ...  # s
    @property
    def period(self) -> float: ...  # s, of the first mode of the lowest string
    @property
    def taps(self) -> list[str]: ...
    def toml(self) -> str: ...

class Run:
    """What a run produced. run["nut"]: shape (rows,), in units["nut"]; the engine's memory,
    read-only."""

    def __getitem__(self, tap: str) -> NDArray[np.float64]: ...
    def keys(self) -> list[str]: ...
    @property
    def units(self) -> dict[str, str]: ...
    @property
    def time(self) -> NDArray[np.float64]: ...  # s, shape (rows,)
    @property
    def tap_rate(self) -> float: ...  # Hz
    @property
    def status(self) -> str: ...  # "ok", "diverged", "not_converged"
    @property
    def failed_step(self) -> int: ...
    @property
    def facts(self) -> dict[str, float]: ...
    @property
    def dofs(self) -> int: ...
    @property
    def steps(self) -> int: ...
    @property
    def wall_seconds(self) -> float: ...  # s
    @property
    def processor_seconds(self) -> float | None: ...  # s; None of a reference
    @property
    def uncertainty(self) -> _Row | None: ...  # of a reference: {"taps": {tap: {window: float}}}
    @property
    def advice(self) -> _Row | None: ...  # how the settings were chosen
    def to_xarray(self) -> Any: ...  # xarray.Dataset

class Trimmed:
    """The cheapest model of a scene within a tolerance, and how it was found."""

    @property
    def found(self) -> bool: ...
    @property
    def path(self) -> list[_Row]: ...
    @property
    def needs(self) -> list[_Row]: ...
    @property
    def toml(self) -> str: ...

def scene(name: _Path) -> Scene: ...
def run(
    scene: Scene | _Path, scheme: str = "", rate: float | None = None, modes: int = 0,
    duration: float | None = None, tap_rate: float | None = None, energy: bool = False,
    options: Mapping[str, _Value] = {}, *, within: str = "", of: str = "", tap: str = "",
    time_limit: float | None = None,  # s of processor
) -> Run: ...
def reference(
    scene: Scene | _Path, reference: str = "", modes: int = 0, duration: float | None = None,
    tap_rate: float | None = None, time_limit: float | None = None, jobs: int = 0,
) -> Run: ...
def run_many(
    scenes: Sequence[Scene | _Path], scheme: str, rate: float = 44100, modes: int = 0,
    duration: float | None = None, tap_rate: float | None = None,
    options: Mapping[str, _Value] = {}, jobs: int = 0,
) -> NDArray[np.float64]: ...  # shape (run, time, tap); NaN after a failure
def compare(
    scene: Scene | _Path, schemes: Sequence[str] = [], rates: Sequence[float] = [],
    modes: int | Sequence[int] = 0, reference: str = "", reference_modes: int = 0,
    controls: bool = False, duration: float | None = None, tap_rate: float | None = None,
    options: Mapping[str, _Value] = {}, repeats: int = 5, out: _Path = "", jobs: int = 0, *,
    cost: Mapping[str, Mapping[float, float]] = {}, time_limit: float | None = None,
) -> Rows: ...
def report(of: Rows | _Path, out: _Path = "") -> list[str]: ...
def suite(file: _Path, out: _Path = "", resume: bool = False, jobs: int = 0) -> list[_Row]: ...
def suite_tables(  # "cells", "maps", "boundaries"; SI units
    file: _Path, out: _Path = "", resume: bool = False, jobs: int = 0,
) -> dict[str, list[_Row]]: ...
def trim(
    scene: Scene | _Path, within: str, of: str = "l2_50ms", tap: str = "", scheme: str = "any",
    duration: float | None = None, tap_rate: float = 44100, reference: str = "",
    reference_modes: int = 0, out: _Path = "", jobs: int = 0,
) -> Trimmed: ...
def problem(
    scene: Scene | _Path, rate: float = 44100, modes: int = 0, duration: float | None = None,
    tap_rate: float | None = None,
) -> Any: ...  # its members: docs/own-scheme/README.md
def judge(
    scene: Scene | _Path, traces: Any, *, name: str = "mine",
    cost: float | Mapping[float, float] | None = None, schemes: Sequence[str] = [],
    duration: float | None = None, tap_rate: float | None = None, tap: str = "",
    reference: str = "", repeats: int = 5, jobs: int = 0,
) -> Rows: ...
def scheme(
    name: str, *, represents: Sequence[str] = [], balance: str = "none",
    source: str = "a scheme in Python", compiled: bool = False,
) -> Any: ...  # a decorator
def check(scheme: str) -> list[_Row]: ...
def plugin(path: _Path) -> None: ...
def schemes() -> list[str]: ...
def scenes() -> list[str]: ...
def made_by() -> dict[str, Any]: ...
