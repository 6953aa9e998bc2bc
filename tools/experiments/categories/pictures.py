"""What is wrong and sure of it: the views whose wrong names are given with the highest confidence."""

import numpy

from categories.figures import UNKNOWN
from segmentation.pictures import font

TILE_PX, MARGIN, CAPTION_PX, COLUMNS, ROWS = 112, 6, 32, 8, 2
TEXT = """\
The surest wrong names of all cues, at most one a thing: what it is → what it was taken for, and the confidence;
**(asked)** in the picture where the user would be asked all the same. Rendered meshes above, rendered strange things
that are named as a category below."""


def surest_errors(report, sets, judged):
    rows = []
    for names, strange in ((("meshes any", "meshes kinect"), False), (("rendered any", "rendered kinect"), True)):
        found = []
        for name in names:
            if (name, "all") not in judged:
                continue
            one = judged[name, "all"]
            one = one.only(~one.right & ((one.category == UNKNOWN) == strange))
            found += [(confidence, name, i, one) for i, confidence in enumerate(one.confidence)]
        rows.append(one_a_thing(sorted(found, key=lambda error: -error[0])))
    if any(rows):
        sheet(sets, rows).save(report.folder / "surest-errors.png", optimize=True)
        report.section("The surest errors", TEXT, "![Views with the surest wrong names](surest-errors.png)")


def one_a_thing(errors):
    seen, out = set(), []
    for error in errors:
        _, _, i, judged = error
        if judged.product[i] not in seen:
            seen.add(judged.product[i])
            out.append(error)
    return out[:COLUMNS * ROWS]


def sheet(sets, groups):
    from PIL import Image, ImageDraw

    lines = [group[start:start + COLUMNS] for group in groups for start in range(0, len(group), COLUMNS)]
    height = TILE_PX + CAPTION_PX + MARGIN
    whole = Image.new("RGB", (COLUMNS * (TILE_PX + MARGIN) + MARGIN, len(lines) * height + MARGIN), "white")
    draw = ImageDraw.Draw(whole)
    for row, line in enumerate(lines):
        for column, (confidence, name, i, judged) in enumerate(line):
            left, top = MARGIN + column * (TILE_PX + MARGIN), MARGIN + row * height
            whole.paste(tile(sets.by_name[name].folder / judged.file[i]), (left, top))
            asked = " (asked)" if judged.asked[i] else ""
            draw.text((left, top + TILE_PX + 2), f"{judged.category[i]} → {judged.predicted[i]}", "black", font(10))
            draw.text((left, top + TILE_PX + 15), f"{confidence:.2f}{asked}", "#555555", font(10))
    return whole.quantize(128)


def tile(file):
    """The object in its surroundings, those paled."""
    from PIL import Image

    stem = str(file)[:-4]
    colour = numpy.array(Image.open(f"{stem}_rgb.png").convert("RGB")).astype(float)
    inside = numpy.array(Image.open(f"{stem}_mask.png")) > 127
    picture = Image.fromarray(numpy.where(inside[..., None], colour, 0.3 * colour + 178).astype(numpy.uint8))
    scale = TILE_PX / max(picture.size)
    picture = picture.resize([max(1, round(side * scale)) for side in picture.size], Image.Resampling.BICUBIC)
    out = Image.new("RGB", (TILE_PX, TILE_PX), (246, 246, 246))
    out.paste(picture, ((TILE_PX - picture.width) // 2, (TILE_PX - picture.height) // 2))
    return out
