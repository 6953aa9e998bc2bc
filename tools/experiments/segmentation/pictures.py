"""Scenes side by side: the truth, the reference's segments and the fast path's."""

from collections import Counter
from pathlib import Path

import numpy

from segmentation.lab import PATHS
from segmentation.scenes import colours, read_labels, true_objects

PANEL = (256, 192)  # width and height, px
MARGIN, HEAD, GAP = 10, 36, 4
FEWEST_PIXELS = 200  # of an object that is counted
FOUND_IOU = 0.5
PALETTE = numpy.array([(86, 180, 233), (0, 158, 115), (240, 228, 66), (0, 114, 178), (204, 121, 167), (152, 223, 138),
                       (148, 103, 189), (23, 190, 207), (255, 187, 120), (140, 86, 75), (188, 189, 34),
                       (197, 176, 213)], float)
WRONG = numpy.array([(214, 0, 0), (255, 120, 90), (150, 20, 60)], float)  # no object's segments
REAL = ("learn4", "learn19", "learn24", "learn28", "learn42")  # of all kinds of scene
CROWDED = ("touching", "stacked", "mixed")
TEXT = """\
Each object has a colour in the truth. A segment has its object's colour where their IoU is at least .5 and it holds no
other object; red is what is wrong: objects merged, parts of one, what is no object. Grey: in no segment. Times as
above. Real scenes and crowded tables were chosen by their kind, frames of the embedded scene by the number of their
objects."""


def pictures(lab, report, scenes, segmented):
    """Ten of `scenes`, by set."""
    chosen = choose(scenes)
    parts = [TEXT]
    for name, words, some in (("real-scenes", "Real scenes", [s for s in chosen if s.is_real]),
                              ("rendered-scenes", "Rendered scenes", [s for s in chosen if not s.is_real])):
        if some:
            sheet(some, segmented).save(report.folder / f"{name}.png", optimize=True)
            parts.append(f"![{words}: the truth, the reference's segments, the fast path's]({name}.png)")
    report.section(f"{number_word(len(chosen))} of them side by side", *parts)


def choose(scenes):
    """Five real ones or, for want of those, more rendered ones."""
    real = scenes.get("real", [])
    chosen = [scene for scene in real if scene.name in REAL] or real[:5]
    embedded = sorted(scenes.get("embedded", []), key=lambda scene: -true_objects(scene).max())[:2]
    kinds = [[scene for scene in scenes["crowded"] if scene.kind == kind] for kind in CROWDED]
    return (chosen + embedded + [scene for turn in zip(*kinds) for scene in turn])[:10]


def number_word(count):
    return "Ten" if count == 10 else str(count)


def sheet(scenes, segmented):
    from PIL import Image, ImageDraw

    columns = 2 if len(scenes) > 3 else 1
    rows = -(-len(scenes) // columns)
    width, height = 3 * PANEL[0] + 2 * GAP + MARGIN, HEAD + PANEL[1] + MARGIN
    whole = Image.new("RGB", (columns * width + MARGIN, rows * height + MARGIN), "white")
    draw = ImageDraw.Draw(whole)
    for place, scene in enumerate(scenes):
        left, top = MARGIN + place % columns * width, MARGIN + place // columns * height
        draw.text((left, top), scene.name if scene.kind in scene.name else f"{scene.name}, {scene.kind}",
                  "black", font(13, "-Bold"))
        for step, (caption, picture) in enumerate(panels(scene, segmented)):
            x = left + step * (PANEL[0] + GAP)
            draw.text((x, top + 18), caption, "#333333", font(12))
            whole.paste(picture, (x, top + HEAD))
    return whole.quantize(palette=palette(), dither=Image.Dither.NONE)


def palette():
    """Greys, and shades of each colour: an image of a third of the bytes."""
    from PIL import Image

    shades = [colour * shade for colour in numpy.vstack([PALETTE, WRONG]) for shade in numpy.linspace(0.3, 1, 14)]
    greys = numpy.linspace(0, 255, 256 - len(shades))[:, None].repeat(3, 1)
    image = Image.new("P", (1, 1))
    image.putpalette(numpy.vstack([shades, greys]).astype(numpy.uint8).tobytes())
    return image


def font(size, style=""):
    import matplotlib
    from PIL import ImageFont

    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / f"fonts/ttf/DejaVuSans{style}.ttf"), size)


def panels(scene, segmented):
    """Captions and pictures of the truth, the reference and the fast path."""
    objects = true_objects(scene)
    counts = numpy.bincount(objects.ravel())
    seen = [number for number in range(1, len(counts)) if counts[number] >= FEWEST_PIXELS]
    paint = numpy.zeros((max(len(counts), 1), 3))
    paint[seen] = PALETTE[numpy.arange(len(seen)) % len(PALETTE)]
    grey = colours(scene).astype(float).mean(-1)
    box = around(numpy.isin(objects, seen))
    yield f"truth: {len(seen)} objects", draw_segments(grey, objects, paint, box)
    for path in reversed(PATHS):
        told = segmented[scene, path]
        labels = read_labels(told.labels).astype(int) if told.labels.is_file() else numpy.zeros_like(objects)
        matched, merges = match(objects, seen, labels)
        by_segment = numpy.zeros((labels.max() + 1, 3))
        for segment in range(1, len(by_segment)):
            right = segment in matched and segment not in merges
            by_segment[segment] = paint[matched[segment]] if right else WRONG[segment % len(WRONG)]
        right = len(matched.keys() - merges)
        yield (f"{path}: {right} of {len(seen)} right, {told.total_ms:.0f} ms",
               draw_segments(grey, labels, by_segment, box))


def match(objects, seen, labels):
    """Objects of the segments that are theirs, one to one, as no two can share more than half; and the segments that
    hold more than half of each of several objects."""
    matched, held = {}, Counter()
    for number in seen:
        inside = objects == number
        segments, common = numpy.unique(labels[inside & (labels > 0)], return_counts=True)
        for segment, pixels in zip(segments, common):
            union = inside.sum() + (labels == segment).sum() - pixels
            if pixels > FOUND_IOU * union:
                matched[int(segment)] = number
            held[int(segment)] += pixels > 0.5 * inside.sum()
    return matched, {segment for segment, count in held.items() if count > 1}


def around(inside):
    """Left, upper, right, lower of what is inside, with a margin, in a panel's proportions."""
    rows, columns = (numpy.flatnonzero(inside.any(axis)) for axis in (1, 0))
    if not len(rows):
        return 0, 0, inside.shape[1], inside.shape[0]
    scale = min(max((columns[-1] - columns[0]) / PANEL[0], (rows[-1] - rows[0]) / PANEL[1]) * 1.25,
                inside.shape[1] / PANEL[0], inside.shape[0] / PANEL[1])
    width, height = scale * PANEL[0], scale * PANEL[1]
    left = min(max(0.5 * (columns[0] + columns[-1] - width), 0), inside.shape[1] - width)
    top = min(max(0.5 * (rows[0] + rows[-1] - height), 0), inside.shape[0] - height)
    return left, top, left + width, top + height


def draw_segments(grey, labels, paint, box):
    """Paints the segments over the image, with outlines, at the size of a panel."""
    from PIL import Image

    inside = labels > 0
    edge = numpy.zeros(labels.shape, bool)
    for axis in (0, 1):
        for step in (-1, 1):
            edge |= numpy.roll(labels, step, axis) != labels
    shade = 0.45 + 0.55 * grey[..., None] / 255
    picture = numpy.where(inside[..., None], paint[labels] * shade, 0.55 * grey[..., None] + 90)
    picture[edge] = numpy.where(inside[edge][:, None], 0.35 * paint[labels[edge]], picture[edge])
    return Image.fromarray(picture.clip(0, 255).astype(numpy.uint8)).resize(PANEL, Image.Resampling.BOX, box)
