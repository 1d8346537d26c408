"""Animations: pictures one after the other in one file."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterable
from contextlib import ExitStack, suppress
from pathlib import Path

import numpy as np
from PIL import Image

from crossview.export.raster import FigureError, check_size, side_by_side

FILMS = (".gif", ".png", ".webp", ".mp4")
"""Endings of animations; a .png holds an animation too (APNG)."""

FASTEST = 50.0
"""Pictures in a second, at most: a GIF counts in hundredths, and browsers slow faster ones down."""

COLORS, SAMPLES = 256, 4
"""Of a GIF, and how many of its pictures tell them. Chosen."""

NEAR = 8
"""How far from the ground, in each part of 255, a colour is not told from it. Chosen."""

QUALITY = 90
"""Of WebP, 0 to 100. Chosen: no block is seen."""


def check_film(path: Path, size: tuple[int, int], per_second: float) -> None:
    """Find mistakes in what is asked of `write_film` before a long computation.

    Raises
    ------
    FigureError
        The ending is no animation's, the size cannot be drawn, the speed is none, or an MP4 is
        asked for where there is no program that makes one.
    """
    if path.suffix.lower() not in FILMS:
        raise FigureError(
            "unknown kind of animation", str(path), "end its name in " + ", ".join(FILMS)
        )
    if not 0.1 <= per_second <= FASTEST:
        raise FigureError(
            f"cannot show {per_second:g} pictures in a second", "", f"choose 0.1 to {FASTEST:g}"
        )
    check_size(size, 1.0)
    if path.suffix.lower() == ".mp4":
        _encoder()


def write_film(
    images: Iterable[Image.Image], path: Path, size: tuple[int, int], per_second: float
) -> None:
    """Write pictures to one file that shows them again and again.

    Parameters
    ----------
    images : iterable of Image
        Of one size.
    path : Path
        Its ending is one of `FILMS`.
    size : (int, int)
        Of the images.
    per_second : float
        How many are shown in a second.

    Raises
    ------
    FigureError
        The program that makes an MP4 refuses them.
    """
    kind = path.suffix.lower()
    if kind == ".mp4":
        _encode(images, path, size, per_second)
        return
    first, *others = images
    how: dict[str, object] = {"save_all": True, "duration": 1000.0 / per_second, "loop": 0}
    if kind == ".gif":
        # one palette, or colours would flicker; coverage keeps those of small things
        some = side_by_side([first, *others][:: max(1, len(others) // SAMPLES)])
        palette = some.quantize(COLORS, method=Image.Quantize.MAXCOVERAGE)
        colors = np.reshape(palette.getpalette() or (), (-1, 3))
        ground = np.asarray(first.convert("RGB"))[0, 0]
        colors[np.abs(colors - ground.astype(int)).max(axis=1) <= NEAR] = ground
        palette.putpalette(colors.reshape(-1).tolist())
        first, *others = (
            image.quantize(palette=palette, dither=Image.Dither.NONE) for image in (first, *others)
        )
        how |= {"optimize": False, "disposal": 1}
    if kind == ".webp":
        how |= {"quality": QUALITY, "method": 4}
    kinds = {".gif": "GIF", ".png": "PNG", ".webp": "WEBP"}
    first.save(path, kinds[kind], append_images=others, **how)


def _encoder() -> str:
    """Return the user's own ffmpeg: the encoders of MP4 have licences that no wheel may hide."""
    found = shutil.which("ffmpeg")
    if found is None:
        raise FigureError(
            "an MP4 is made by the program ffmpeg, which is not here",
            "",
            "install it, or end the name in .webp or .gif",
        )
    return found


def _encode(
    images: Iterable[Image.Image], path: Path, size: tuple[int, int], per_second: float
) -> None:
    """Give pictures to ffmpeg, as H.264 that all players know."""
    command = [
        *(_encoder(), "-loglevel", "error", "-y"),
        *("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}"),
        *("-r", f"{per_second:g}", "-i", "-", "-an"),
        # both sides even, as colours of half resolution want
        *("-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p"),
        *("-movflags", "+faststart", "-f", "mp4", str(path)),
    ]
    with ExitStack() as stack:
        ran = stack.enter_context(
            subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
        )
        if ran.stdin is None or ran.stderr is None:
            raise FigureError("ffmpeg cannot be started")
        with suppress(BrokenPipeError):  # it says itself why it has ended
            for image in images:
                ran.stdin.write(image.convert("RGB").tobytes())
        with suppress(BrokenPipeError):
            ran.stdin.close()
        said = ran.stderr.read().decode(errors="replace").strip()
    if ran.returncode:
        raise FigureError("ffmpeg makes no MP4 of this", "", said.splitlines()[-1] if said else "")
