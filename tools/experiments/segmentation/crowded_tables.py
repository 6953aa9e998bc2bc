"""Crowded tables: things that touch, stand on and hide each other, which the embedded scene's never do."""

import numpy

from segmentation.depth_camera import Solid, Table, View

KINDS = {  # how the next thing is put to those that are there: shares; from .. to things
    "apart": ({"free": 1}, (5, 9)),
    "touching": ({"touch": 0.85, "free": 0.15}, (6, 10)),
    "stacked": ({"stack": 0.6, "free": 0.2, "touch": 0.2}, (6, 10)),
    "occluded": ({"behind": 0.7, "free": 0.3}, (6, 10)),
    "mixed": ({"touch": 0.3, "stack": 0.25, "behind": 0.2, "free": 0.25}, (11, 17)),
}
SHAPES, SHARES = ("box", "cylinder", "vessel", "ball"), (0.5, 0.22, 0.2, 0.08)
FREE_M = (0.01, 0.05)
TRIES = 80
BORDER_PX = 8  # of the image, at 640 x 480; nothing is cut
MOST_HIDDEN = 0.7  # of the smaller of two things' rectangles in the image


class Thing:
    """A solid that still moves; its footprint is a convex polygon around its place, counter-clockwise."""

    def __init__(self, rng, shape=None):
        self.shape = shape or rng.choice(SHAPES, p=SHARES)
        self.lies = self.shape == "cylinder" and rng.random() < 0.2
        if self.shape == "box":
            self.half = tuple(rng.uniform((0.025, 0.02, 0.015), (0.10, 0.07, 0.10)))
        elif self.shape == "ball":
            self.half = (rng.uniform(0.03, 0.05),) * 3
        else:
            radius = rng.uniform(0.03, 0.05 if self.shape == "cylinder" else 0.075)
            self.half = (radius, radius, rng.uniform(0.03, 0.08))
        self.colour = tuple(rng.uniform(0.15, 0.95, 3))
        self.yaw = rng.uniform(0, 2 * numpy.pi)
        self.place = numpy.zeros(2)
        self.bottom = 0.0
        self.rectangle = None  # in the image, px: left and upper, right and lower

    @property
    def height(self):
        return 2 * (self.half[0] if self.lies else self.half[2])

    @property
    def top(self):
        return self.bottom + self.height

    @property
    def is_flat(self):
        return self.shape in ("box", "cylinder") and not self.lies

    @property
    def reach(self):
        return float(numpy.linalg.norm(self.outline() - self.place, axis=1).min())

    def outline(self):
        if self.shape == "box" or self.lies:
            x, y = self.half[2] if self.lies else self.half[0], self.half[1]
            corners = numpy.array([[x, y], [-x, y], [-x, -y], [x, -y]])
        else:
            angles = numpy.arange(0, 2 * numpy.pi, numpy.pi / 12)
            corners = self.half[0] * numpy.stack([numpy.cos(angles), numpy.sin(angles)], 1)
        c, s = numpy.cos(self.yaw), numpy.sin(self.yaw)
        return corners @ numpy.array([[c, s], [-s, c]]) + self.place

    def solid(self):
        c, s = numpy.cos(self.yaw), numpy.sin(self.yaw)
        turn = numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        if self.lies:  # its axis along the outline's x
            turn = turn @ numpy.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
        return Solid(self.shape, self.half, turn, numpy.array([*self.place, self.bottom + self.height / 2]),
                     self.colour)


def gap(a, b):
    """A lower bound of the distance of convex polygons; negative where they overlap."""
    best = -numpy.inf
    for one, other in ((a, b), (b, a)):
        edges = numpy.roll(one, -1, 0) - one
        normals = numpy.stack([edges[:, 1], -edges[:, 0]], 1) / numpy.linalg.norm(edges, axis=1)[:, None]
        best = max(best, float(((other[None] - one[:, None]) @ normals[:, :, None])[..., 0].min(1).max()))
    return best


def make_table(kind, seed, count=None, scale=1.0):
    """The same things and the same view at each `scale` of the image."""
    rng = numpy.random.default_rng([seed, list(KINDS).index(kind), count or 0])
    shares, (fewest, most) = KINDS[kind]
    view = View(numpy.radians(rng.uniform(34, 46)), rng.uniform(0.85, 1.15))
    wanted = count or rng.integers(fewest, most + 1)
    things = []
    for _ in range(12 * wanted):
        if len(things) == wanted:
            break
        how = rng.choice(list(shares), p=list(shares.values())) if things else "free"
        thing = put(Thing(rng), how, things, view, rng)
        if thing:
            things.append(thing)
    view = View(view.tilt_rad, view.distance_m, scale)
    return Table([thing.solid() for thing in things], view, rng.uniform(0.55, 0.9),
                 view.aim_y_m - rng.uniform(0.45, 0.7), view.aim_y_m + rng.uniform(0.45, 0.8),
                 tuple(rng.uniform(0.4, 0.8) * numpy.array([1, 0.93, 0.85])), seed)


def put(thing, how, things, view, rng):
    """The thing at a place that is free; None where none was found."""
    for _ in range(TRIES):
        apart_m = PLACES[how](thing, things, view, rng)
        if apart_m is not None and fits(thing, things, apart_m, view):
            return thing
    return None


def fits(thing, things, apart_m, view):
    outline = thing.outline()
    for other in things:
        if thing.bottom < other.top - 1e-6 and other.bottom < thing.top - 1e-6 and \
                gap(outline, other.outline()) < apart_m:
            return False
    ends = numpy.vstack([numpy.c_[outline, numpy.full(len(outline), z)] for z in (thing.bottom, thing.top)])
    pixels = view.pixels(ends)
    thing.rectangle = pixels.min(0), pixels.max(0)
    if (thing.rectangle[0] < BORDER_PX).any() or (thing.rectangle[1] > numpy.array(view.size) - BORDER_PX).any():
        return False
    return all(common(thing.rectangle, other.rectangle) < MOST_HIDDEN for other in things)


def common(a, b):
    """Of rectangles, as a share of the smaller."""
    sides = numpy.minimum(a[1], b[1]) - numpy.maximum(a[0], b[0])
    return sides.clip(0).prod() / min((a[1] - a[0]).prod(), (b[1] - b[0]).prod())


def free(thing, things, view, rng):
    spread = 0.2 + 0.012 * len(things)
    thing.bottom = 0.0
    thing.place = numpy.array([rng.uniform(-1, 1) * spread * 1.2, view.aim_y_m + rng.uniform(-0.8, 1) * spread])
    return rng.uniform(*FREE_M)


def touch(thing, things, view, rng):
    """Slid to another thing until they meet; half of the boxes side to side."""
    base = things[rng.integers(len(things))]
    angle = rng.uniform(0, 2 * numpy.pi)
    if base.shape == "box" and rng.random() < 0.5:
        thing.yaw = base.yaw
        angle = base.yaw + rng.integers(4) * numpy.pi / 2
    direction = numpy.array([numpy.cos(angle), numpy.sin(angle)])
    thing.bottom = base.bottom
    slide(thing, base, direction, 0.0)
    return -1e-4 if thing.bottom == 0 else None


def behind(thing, things, view, rng):
    base = things[rng.integers(len(things))]
    direction = numpy.array([rng.uniform(-0.5, 0.5), 1.0])
    thing.bottom = 0.0
    slide(thing, base, direction / numpy.linalg.norm(direction), rng.uniform(0.01, 0.06))
    return 0.005


def slide(thing, base, direction, apart_m):
    low, high = 0.0, 0.5
    for _ in range(24):
        middle = 0.5 * (low + high)
        thing.place = base.place + middle * direction
        low, high = (middle, high) if gap(thing.outline(), base.outline()) < apart_m else (low, middle)
    thing.place = base.place + high * direction


def stack(thing, things, view, rng):
    bases = [other for other in things if other.is_flat and other.top + thing.height < 0.45
             and thing.reach < 1.3 * other.reach and thing.shape != "ball" and not thing.lies]
    if not bases:
        return None
    base = bases[rng.integers(len(bases))]
    thing.bottom = base.top
    thing.place = base.place + rng.uniform(-0.5, 0.5, 2) * base.reach
    return 0.0


PLACES = {"free": free, "touch": touch, "behind": behind, "stack": stack}
