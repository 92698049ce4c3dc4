import numpy as np
import numpy.typing as npt

def read(
    path: bytes, kind: str | None, round: bool
) -> tuple[str, npt.NDArray[np.float64], npt.NDArray[np.uint8] | None, list[tuple[int, tuple[int, int]]]]: ...
def write(
    path: bytes, kind: str, queries: npt.NDArray[np.float64], labels: npt.NDArray[np.bool_] | None
) -> None: ...
def kind_of(path: bytes) -> str: ...
