import io

import numpy as np
import pytest
from golden import GOLDEN, REFERENCES, drawn, drawn_by, pixels, write_failure

from fakesss.gpu import renderer_facts

LARGEST, MEAN = 2, 0.1  # code values of 255, on another renderer than the references'


@pytest.mark.gl
@pytest.mark.parametrize("name", GOLDEN)
def test_picture_is_unchanged(name: str) -> None:
    reference, png = REFERENCES / f"{name}.png", drawn(name)
    if np.array_equal(pixels(io.BytesIO(png)), pixels(reference)):  # zlib may have packed the file otherwise
        return
    failed = write_failure(name, png)
    difference = np.abs(pixels(failed / f"{name}.image.png") - pixels(reference))
    told = f"{name}: largest difference {difference.max()}, mean {difference.mean():.3f}; see {failed.name}/"
    assert renderer_facts() != drawn_by(), f"{told}; the renderer is the same, so the pixels must be"
    assert difference.max() <= LARGEST and difference.mean() <= MEAN, told


def test_there_is_a_reference_for_each_and_no_other() -> None:
    assert {path.stem for path in REFERENCES.glob("*.png")} == GOLDEN.keys()
