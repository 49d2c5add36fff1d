"""Runs as differentiable functions in PyTorch, by exact derivatives (docs/python.md).

    length = torch.tensor(1.2, dtype=torch.float64, requires_grad=True)
    angle = lagroid.torch.observe("examples/pendulum.toml", {"parameters.length": length}, of=["final.q"])
    angle.sum().backward()
    length.grad
"""

from __future__ import annotations

import os
import tomllib
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _lagroid
from .errors import SceneError, SolveError
from .scenes import SceneLike, made
from .studies import GradientTable, gradient

try:
    import torch
except ModuleNotFoundError as missing:
    if missing.name != "torch":
        raise
    raise ModuleNotFoundError("lagroid.torch needs PyTorch: apt-get install python3-torch", name="torch") from None

__all__ = ["observe"]

_Array = NDArray[np.float64]

#: Below so many digits derivatives are told to be in doubt.
_FEWEST_DIGITS = 3


def observe(
    scene: SceneLike,
    at: Mapping[str, torch.Tensor],
    *,
    of: Sequence[str] = ("final",),
    set: Optional[Mapping[str, Any]] = None,
) -> torch.Tensor:
    """What a scene's run shows, as a function of numbers of the scene that autograd differentiates once: `at` has a
    tensor for each key, as {"initial.momentum": p, "parameters.length": l}, which takes the place of what the scene
    says there. `of` and the order of what is returned are those of `lagroid.gradient`, which has the derivatives; words
    of one place (final, node.10, integral) stand together. `set` holds other values, without derivatives.

    A tensor is of double precision, on the processor, and of the shape that its key has in the scene: () for a number,
    (n,) for n of them. Dimensions before it are those of a batch, which broadcast; its runs are made side by side, and
    the result has them before its own dimension.

    Raises what `lagroid.gradient` raises; TypeError and ValueError for tensors that are not such; and SceneError for a
    start that is not given by its momentum, because it would change with parameters. A RuntimeWarning tells that fewer
    than three digits of the derivatives are left."""
    words = [of] if isinstance(of, str) else list(of)
    _require_order(words)
    if not at:
        raise ValueError("observe: names no number of the scene; give one, as {'parameters.length': length}")
    shapes = _shapes(made(scene, set), at)
    batch = _common([_batch(key, tensor, shapes[key]) for key, tensor in at.items()])
    if not batch.numel():
        raise ValueError(f"observe: a batch of shape {tuple(batch)} has no members; give it some")
    # Columns of derivatives by the start come first.
    keys = sorted(at, key=lambda key: not key.startswith("initial."))
    numbers = torch.cat([at[key].expand(batch + shapes[key]).reshape(batch.numel(), -1) for key in keys], dim=1)

    def run(x: _Array) -> GradientTable:
        given = dict(set or {})
        for key in keys:
            size = int(np.prod(shapes[key]))
            given[key], x = x[:size].reshape(shapes[key]), x[size:]
        return gradient(scene, of=words, wrt=keys, set=given)

    found = _tables(run, numbers.detach().numpy())
    fewest = min(each.digits_left for each in found)
    if fewest < _FEWEST_DIGITS:
        growth = max(each.growth for each in found)
        warnings.warn(
            f"observe: derivatives grew {growth:.3g} times: of sixteen digits {fewest:.1f} are left; take fewer steps",
            RuntimeWarning,
            stacklevel=2,
        )
    values = torch.from_numpy(np.stack([each.values for each in found]))
    derivatives = torch.from_numpy(np.stack([each.derivatives for each in found]))
    out: torch.Tensor = _Observed.apply(numbers, values, derivatives)
    return out.reshape(batch + (-1,))


class _Observed(torch.autograd.Function):  # type: ignore[misc]
    """Rows of values as functions of rows of numbers, of which the derivatives are known."""

    @staticmethod
    def forward(context: Any, numbers: torch.Tensor, values: torch.Tensor, derivatives: torch.Tensor) -> torch.Tensor:
        context.save_for_backward(numbers, derivatives)
        return values

    @staticmethod
    def backward(context: Any, by_values: torch.Tensor) -> tuple[torch.Tensor, None, None]:
        return _Backward.apply(by_values, *context.saved_tensors), None, None


class _Backward(torch.autograd.Function):  # type: ignore[misc]
    """Their derivatives: functions of the numbers, too, whose own derivatives are not known. Autograd would take them
    for zero."""

    @staticmethod
    def forward(
        context: Any, by_values: torch.Tensor, numbers: torch.Tensor, derivatives: torch.Tensor
    ) -> torch.Tensor:
        return torch.einsum("bi,bij->bj", by_values, derivatives)

    @staticmethod
    def backward(context: Any, *_: torch.Tensor) -> None:
        raise NotImplementedError("lagroid.torch: runs have first derivatives alone; differentiate them once")


def _tables(run: Callable[[_Array], GradientTable], rows: _Array) -> list[GradientTable]:
    """Of every row; what is mistaken about one names it."""

    def member(i: int) -> GradientTable:
        try:
            return run(rows[i])
        except (SceneError, SolveError) as error:
            if len(rows) == 1:
                raise
            raise type(error)(f"member {i} of the batch: {error}") from None

    with ThreadPoolExecutor(os.cpu_count()) as threads:  # each waits for a program
        found = list(threads.map(member, range(len(rows))))
    for i, each in enumerate(found):
        if each.of != found[0].of:
            raise SceneError(f"member {i} of the batch: has other events than the first; ask for those that all have")
        if len(each.by) != rows.shape[1]:
            raise SceneError(f"observe: {rows.shape[1]} numbers are given for {', '.join(each.by)}; name each once")
    return found


def _require_order(words: Sequence[str]) -> None:
    """What is returned is in the order of the words, unless they go back to a place."""
    left: list[str] = []
    for word in words:
        first, _, rest = word.partition(".")
        place = {"node": f"node.{rest.partition('.')[0]}", "event": word}.get(first, first)
        if place in left[:-1]:
            raise ValueError(f"of: {word} comes after another place; name what is of {place} together")
        if left[-1:] != [place]:
            left.append(place)


def _shapes(scene: _lagroid.Scene, keys: Iterable[str]) -> dict[str, tuple[int, ...]]:
    """Those of the numbers that the scene has at keys."""
    tables = tomllib.loads(scene.toml())
    if not {"momentum", "state"} & tables.get("initial", {}).keys():
        raise SceneError(
            f"{scene.name}: initial: a start that is not given by its momentum (or state) changes with parameters; "
            "give momentum"
        )
    out = {}
    for key in keys:
        if key.partition(".")[0] not in ("initial", "parameters"):
            raise SceneError(f"{key}: derivatives are by initial.NAME or parameters.NAME")
        value: Any = tables
        try:
            for part in key.split("."):
                value = value[int(part) if isinstance(value, list) else part]
        except (KeyError, IndexError, TypeError, ValueError):
            raise SceneError(f"{key}: is not in the scene, which tells its shape; write it there or into set") from None
        numbers = np.array(value)
        if numbers.dtype.kind not in "if":
            raise SceneError(f"{key}: is no number and no array of them")
        out[key] = numbers.shape
    return out


def _common(batches: Sequence[torch.Size]) -> torch.Size:
    try:
        return torch.broadcast_shapes(*batches)
    except RuntimeError:
        told = ", ".join(str(tuple(each)) for each in batches)
        raise ValueError(f"observe: batches of shapes {told} do not broadcast; give them common dimensions") from None


def _batch(key: str, tensor: torch.Tensor, shape: tuple[int, ...]) -> torch.Size:
    """The dimensions before its own."""
    if not isinstance(tensor, torch.Tensor):
        raise TypeError(f"{key}: expected a tensor, got {type(tensor).__name__}; what is not differentiated is for set")
    if tensor.dtype != torch.float64:
        raise TypeError(f"{key}: steps are made in double precision, not in {tensor.dtype}; give it as x.double()")
    if tensor.device.type != "cpu":
        raise TypeError(f"{key}: steps are made by the processor, the tensor is on {tensor.device}; give it as x.cpu()")
    before = tensor.dim() - len(shape)
    if before < 0 or tensor.shape[before:] != shape:
        raise ValueError(f"{key}: expected shape {shape}, or one that ends with it, got {tuple(tensor.shape)}")
    return tensor.shape[:before]
