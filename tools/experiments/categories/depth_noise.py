"""What a depth camera does to depth, measured by the same code in real and in rendered scenes: noise and steps on
tables, outlines, creases, and where there is no depth at all. In disparity, where a structured-light camera errs."""

import json
from dataclasses import dataclass

import numpy
from numpy.lib.stride_tricks import sliding_window_view
from scipy import ndimage, signal

from pose.scene_files import positions, read_pcd

KINECT_M_PX = 42.9  # a Kinect's disparity, px, is this over the depth
TABLE_BAND_M = 0.015  # unlabelled points this close to the table's plane lie on it
BESIDE_OBJECTS_PX = 10  # no table there
EDGE_M = 0.03  # what is that much farther is behind
SMOOTHED_ROWS = 15  # of an outline that is held against itself
FEWEST_CREASE_COLUMNS, STEEPEST, WEAKEST_PX = 15, 0.8, 0.5
BRIGHTNESS = {"dark": (0, 50), "middling": (50, 150), "bright": (150, 256)}


@dataclass(frozen=True)
class DepthScene:
    """Rows x columns."""

    depth_m: numpy.ndarray  # NaN: none
    table: numpy.ndarray
    objects: numpy.ndarray  # number of each pixel's object, 0 none
    grey: numpy.ndarray
    categories: dict  # by number, as far as they are known

    @property
    def disparity_px(self):
        return KINECT_M_PX / self.depth_m


def real_scene(path, categories):
    points = read_pcd(path)
    labels = points["label"].astype(int)
    objects = numpy.where(labels >= 20, labels // 10, 0)
    packed = numpy.ascontiguousarray(points["rgba" if "rgba" in points.dtype.names else "rgb"]).view(numpy.uint32)
    grey = ((packed >> 16 & 255) + (packed >> 8 & 255) + (packed & 255)) / 3
    return DepthScene(points["z"].astype(float), clear(labels // 10 == 0, labels > 0, objects), objects, grey,
                      {int(number): name for number, name in categories.get(path.stem, {}).items()})


def rendered_scene(path):
    from PIL import Image

    p = positions(read_pcd(path))
    objects = numpy.array(Image.open(path.with_name(f"{path.stem}_labels.png"))).astype(int)
    truth = json.loads(path.with_name(f"{path.stem}_truth.json").read_text())
    height = p @ numpy.array(truth["table"]["normal"]) + truth["table"]["offset_m"]
    grey = numpy.array(Image.open(path.with_name(f"{path.stem}_rgb.png")).convert("RGB")).mean(-1)
    return DepthScene(p[..., 2], clear(numpy.abs(height) < TABLE_BAND_M, objects == 0, objects), objects, grey,
                      {one["label"]: one["category"] for one in truth["objects"] or []})


def clear(table, too, objects):
    return table & too & ~ndimage.binary_dilation(objects > 0, iterations=BESIDE_OBJECTS_PX)


def surface_residual(disparity, size, step, curved=False):
    """Rms of what a plane (curved: a paraboloid) leaves of each window of `size` px that has all its pixels. A plane in
    space is one in disparity."""
    if min(disparity.shape) < size:
        return numpy.empty(0)
    windows = sliding_window_view(disparity, (size, size))[::step, ::step].reshape(-1, size * size)
    windows = windows[numpy.isfinite(windows).all(1)]
    v, u = (numpy.indices((size, size)).reshape(2, -1) - size // 2) / size
    terms = [numpy.ones_like(u), u, v] + ([u * u, u * v, v * v] if curved else [])
    basis, _ = numpy.linalg.qr(numpy.stack(terms, 1))
    left = windows - (windows @ basis) @ basis.T
    return numpy.sqrt((left ** 2).sum(1) / (size * size - len(terms)))


def equal_neighbours(scene, axis):
    """Share of neighbouring pixels of the table, along an axis of the image, whose depths are the same."""
    depth = numpy.where(scene.table, scene.depth_m, numpy.nan)
    apart = numpy.abs(numpy.diff(depth, axis=axis))
    return float((apart[numpy.isfinite(apart)] < 1e-6).mean())


@dataclass(frozen=True)
class Outline:
    """One side of an object."""

    rows: numpy.ndarray
    edges: numpy.ndarray  # the last column of the object
    gaps: numpy.ndarray  # pixels without depth between it and what is behind
    steps: numpy.ndarray  # disparity between both, px: as wide is the projector's shadow


def outlines(scene, side):
    """Of each object that has something behind it; `side`: -1 left, 1 right."""
    depth = scene.depth_m[:, ::side]  # the side that is looked at is the right one
    objects = scene.objects[:, ::side]
    for number in numpy.unique(objects[objects > 0]):
        found = [(row, *edge) for row, edge in ((row, edge_of(depth[row], objects[row] == number))
                                                for row in numpy.flatnonzero((objects == number).sum(1) >= 20)) if edge]
        if found:
            yield Outline(*numpy.array(found, float).T)


def edge_of(depth, inside):
    """Of a row: the last column of the object, the number of pixels without depth that follow, and the step in
    disparity; None: the object does not end before something that is behind it."""
    last = numpy.flatnonzero(inside)[-1]
    near = depth[max(last - 10, 0):last - 3]
    if not numpy.isfinite(near).any():
        return None
    start = last - 6
    beyond = depth[start:last + 15] - numpy.nanmedian(near)
    other = numpy.flatnonzero(numpy.abs(beyond) > EDGE_M)
    if not len(other) or beyond[other[0]] < 0:
        return None
    own = numpy.flatnonzero(numpy.isfinite(beyond[:other[0]]))
    if not len(own):
        return None
    step_px = KINECT_M_PX / depth[start + own[-1]] - KINECT_M_PX / depth[start + other[0]]
    return start + own[-1], other[0] - own[-1] - 1, step_px


def raggedness(outline):
    """Squares of how far an outline strays from its smoothed self, px, row by row."""
    breaks = numpy.flatnonzero((numpy.diff(outline.rows) > 1) | (numpy.abs(numpy.diff(outline.edges)) > 4)) + 1
    runs = [run for run in numpy.split(outline.edges, breaks) if len(run) >= SMOOTHED_ROWS]
    return numpy.concatenate([(run - signal.savgol_filter(run.astype(float), SMOOTHED_ROWS, 2)) ** 2 for run in runs]
                             or [numpy.empty(0)])


def no_depth(scene, number):
    """Of an object's pixels away from its outline: their brightness, and whether they have no depth."""
    whole = ndimage.binary_fill_holes(ndimage.binary_closing(scene.objects == number, iterations=2))
    whole = ndimage.binary_erosion(whole, iterations=4)
    return scene.grey[whole], ~numpy.isfinite(scene.depth_m[whole])


def crease(disparity):
    """Mean second differences at steps of 3 and 6 px over those at 12, across the top front edge of a box whose pixels
    have a disparity; None: there is no such edge. A sharp edge has .25 and .5."""
    bend = numpy.full(disparity.shape, numpy.nan)
    bend[12:-12] = disparity[:-24] - 2 * disparity[12:-12] + disparity[24:]
    columns = numpy.flatnonzero(numpy.isfinite(bend).any(0))
    if len(columns) < FEWEST_CREASE_COLUMNS:
        return None
    rows = numpy.nanargmin(bend[:, columns], axis=0)
    strong = bend[rows, columns] < -WEAKEST_PX
    columns, rows = columns[strong], rows[strong]
    for within in (6, 3, 1.5, 1.5):
        if len(columns) < FEWEST_CREASE_COLUMNS:
            return None
        line = numpy.polyfit(columns, rows, 1)
        keep = numpy.abs(rows - numpy.polyval(line, columns)) <= within
        columns, rows = columns[keep], rows[keep]
    if len(columns) < FEWEST_CREASE_COLUMNS or abs(line[0]) > STEEPEST:
        return None
    return bends(disparity, columns, numpy.polyval(line, columns))


def bends(disparity, columns, rows):
    """The ratios, of the mean profile along the edge; a profile is read between pixels."""
    offsets = numpy.arange(-15, 16)
    at = rows[:, None] + offsets[None]
    low = numpy.floor(at).astype(int).clip(0, len(disparity) - 2)
    profiles = disparity[low, columns[:, None]] * (1 - (at - low)) + disparity[low + 1, columns[:, None]] * (at - low)
    profiles = profiles[numpy.isfinite(profiles).all(1)]
    if len(profiles) < FEWEST_CREASE_COLUMNS:
        return None
    mean = profiles.mean(0)
    middle = min(range(13, 18), key=lambda i: mean[i - 12] - 2 * mean[i] + mean[i + 12])
    d3, d6, d12 = (mean[middle - step] - 2 * mean[middle] + mean[middle + step] for step in (3, 6, 12))
    return (d3 / d12, d6 / d12) if d12 < -WEAKEST_PX else None
