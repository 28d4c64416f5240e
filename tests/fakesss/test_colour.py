import numpy as np
import pytest

from fakesss.colour import decode_srgb, encode_srgb, luminance, to_8bit


def test_every_code_value_survives_decoding_and_encoding() -> None:
    codes = np.arange(256)
    np.testing.assert_array_equal(to_8bit(decode_srgb(codes / 255)), codes)


def test_published_values_of_the_standard() -> None:
    assert encode_srgb(np.array(0.0031308)) == pytest.approx(0.04045, abs=1e-5)
    assert encode_srgb(np.array(0.18)) == pytest.approx(0.4613561, abs=1e-6)
    assert decode_srgb(np.array(0.5)) == pytest.approx(0.2140411, abs=1e-6)


def test_the_two_pieces_meet_and_the_curve_rises() -> None:
    light = np.linspace(0, 1, 100_001)
    assert (np.diff(encode_srgb(light)) > 0).all()
    assert abs(encode_srgb(np.array(0.0031308)) - encode_srgb(np.array(0.0031309))) < 2e-6


def test_light_beyond_white_clips_and_halves_round_up() -> None:
    np.testing.assert_array_equal(to_8bit(np.array([-1.0, 0.0, 1.0, 7.0])), [0, 0, 255, 255])
    assert to_8bit(decode_srgb(np.array(0.5 / 255 + 1e-9))) == 1


def test_white_has_luminance_one() -> None:
    assert luminance(np.ones((2, 2, 3))) == pytest.approx(np.ones((2, 2)))
