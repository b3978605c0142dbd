from collections.abc import Sequence
from typing import Any

import jax
import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import Model, Trial

__all__ = ["cost", "outputs"]

class _Callable:
    names: list[str]
    start: NDArray[np.float64]
    def __call__(self, values: ArrayLike, *excitations: ArrayLike) -> jax.Array: ...

def cost(model: Model, trials: Sequence[Trial], parameters: Sequence[str], **options: Any) -> _Callable: ...
def outputs(model: Model, trials: Sequence[Trial], parameters: Sequence[str], **options: Any) -> _Callable: ...
