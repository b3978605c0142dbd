from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from . import Model, Trial

__all__ = ["cost", "outputs"]

class _Callable:
    names: list[str]
    start: NDArray[np.float64]
    def __call__(self, values: torch.Tensor, *excitations: torch.Tensor) -> torch.Tensor: ...

def cost(model: Model, trials: Sequence[Trial], parameters: Sequence[str], **options: Any) -> _Callable: ...
def outputs(model: Model, trials: Sequence[Trial], parameters: Sequence[str], **options: Any) -> _Callable: ...
