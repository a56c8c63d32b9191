# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Pictures put together: rows with labels, enlarged pieces, an animation. Pillow, which matplotlib brings along."""
import pathlib
import sys

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))
import exr  # noqa: E402

LINE = 16  # pixels of a label
FONT = pathlib.Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"  # knows Greek


def of_exr(file):
    """As an 8-bit sRGB picture, of linear radiance cut at 1."""
    channels = exr.read(file)[1]
    x = np.clip(np.nan_to_num(np.stack([channels[c].astype(float) for c in "RGB"], -1)), 0, 1)
    return Image.fromarray(np.round(255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)).astype(np.uint8))


def stacked(rows):
    """One below the other, each (label or "", picture)."""
    sheet = Image.new("RGB", (max(p.width for _, p in rows), sum(p.height + (LINE if label else 0) for label, p in rows)))
    draw, font, y = ImageDraw.Draw(sheet), ImageFont.truetype(FONT, 12), 0
    for label, picture in rows:
        if label:
            draw.text((6, y + 1), label, fill=(220, 220, 220), font=font)
            y += LINE
        sheet.paste(picture, ((sheet.width - picture.width) // 2, y))
        y += picture.height
    return sheet


def sheet(cells, columns):
    """Rows of labelled pictures of one size, each (label, picture)."""
    rows = []
    for k in range(0, len(cells), columns):
        some = [stacked([cell]) for cell in cells[k:k + columns]]
        row = Image.new("RGB", (columns * (some[0].width + 4) - 4, some[0].height))
        for j, one in enumerate(some):
            row.paste(one, (j * (one.width + 4), 0))
        rows.append(("", row))
    return stacked(rows)


def pieces(pictures, centres, side, width):
    """Squares of the pictures by turns, so that at each centre the first is left of the second; enlarged to the width in all."""
    count = len(centres) * len(pictures)
    edge = width // count
    strip = Image.new("RGB", (width, edge))
    for k, (x, y) in enumerate(centres):
        for j, picture in enumerate(pictures):
            box = (x - side / 2, y - side / 2, x + side / 2, y + side / 2)
            strip.paste(picture.resize((edge - 1, edge - 1), Image.Resampling.BICUBIC, box), ((k * len(pictures) + j) * edge, 0))
    return strip


def save(picture, path):
    """Beside, then renamed: no half picture replaces a whole one."""
    fresh = path.with_name(path.name + ".new")
    picture.save(fresh, format=path.suffix[1:].upper())
    fresh.replace(path)


def animate(pictures, path, milliseconds=80):
    """Forth and back, with a rest at both ends, for ever."""
    order = [*pictures, *pictures[-2:0:-1]]
    ends = {0, len(pictures) - 1}
    fresh = path.with_name(path.name + ".new")
    order[0].save(fresh, format="GIF", save_all=True, append_images=order[1:], loop=0,
                  duration=[milliseconds * (8 if k in ends else 1) for k in range(len(order))])
    fresh.replace(path)
