"""Write scenes as a moving picture: GIF with Pillow, MP4 with ffmpeg if it is installed.

Only this module imports Pillow.
"""

from __future__ import annotations

import io
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from PIL import Image

from reportgen.base.errors import TypesetterError
from reportgen.base.units import Language
from reportgen.base.words import word
from reportgen.drawing import Scene
from reportgen.writers import picture_files

SECONDS = 0.05
"""Duration of a frame in seconds; GIF counts in hundredths."""
COLOURS = 64
"""Number of colours of all frames: the few of a drawing, and their blends at its edges."""
TOLD = 4
"""Number of frames from which the palette is computed."""


def gif(scenes: Sequence[Scene], language: Language, dpi: int) -> bytes:
    """Return an animated GIF of scenes of one size that repeats for ever."""
    frames = _frames(scenes, language, dpi)
    width, height = frames[0].size
    telling = frames[:: max(len(frames) // TOLD, 1)]
    all_colours = Image.new("RGB", (width, height * len(telling)))
    for number, frame in enumerate(telling):
        all_colours.paste(frame, (0, number * height))
    palette = all_colours.quantize(COLOURS, Image.Quantize.MAXCOVERAGE)
    first, *others = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    stream = io.BytesIO()
    first.save(stream, "GIF", save_all=True, append_images=others, duration=round(1000 * SECONDS), loop=0)
    return stream.getvalue()


def mp4(scenes: Sequence[Scene], language: Language, dpi: int) -> bytes:
    """Return a film of scenes of one size in H.264, which any player and presentation program supports.

    Raises `TypesetterError` if ffmpeg is missing or fails.
    """
    ffmpeg = shutil.which("ffmpeg")
    if ffmpeg is None:
        raise TypesetterError(word("no_ffmpeg", language))
    frames = _frames(scenes, language, dpi)
    # H.264 halves the colour resolution in both directions.
    width, height = (side - side % 2 for side in frames[0].size)
    raw = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", f"{1 / SECONDS:g}", "-i", "-")
    coded = ("-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-bitexact")
    with tempfile.TemporaryDirectory(prefix="film-") as folder:
        path = Path(folder) / "film.mp4"
        content = b"".join(frame.crop((0, 0, width, height)).tobytes() for frame in frames)
        ran = subprocess.run([ffmpeg, "-loglevel", "error", *raw, *coded, path], input=content, capture_output=True)
        if ran.returncode:
            raise TypesetterError("ffmpeg: " + "\n".join(ran.stderr.decode(errors="replace").splitlines()[:4]))
        return path.read_bytes()


def _frames(scenes: Sequence[Scene], language: Language, dpi: int) -> list[Image.Image]:
    return [Image.open(io.BytesIO(png)).convert("RGB") for png in picture_files.pngs(scenes, language, dpi)]
