"""A depth camera of any resolution looks at simple solids: rays against boxes, cylinders, vessels and balls; then the
noise, the quantisation, the shadows and the lost edges of structured light."""

import json
from dataclasses import dataclass

import numpy
from scipy import ndimage

from pose.scene_files import write_labels, write_pcd

FOCAL_PX = 525.0  # at 640 x 480
BASELINE_M = 0.075  # from the projector to the camera
STEPS_PER_PX = 8  # of disparity, at 640 x 480
SMOOTHED_PX = 0.7  # correlation of the noise, at 640 x 480
CLOSE_M, EDGE_M = 0.03, 0.02  # of depths that differ no more, none hides the other; more is an edge
LOST_AT_EDGE, BETWEEN_AT_EDGE = 0.5, 0.08  # shares of pixels: no depth; a depth between both surfaces
GRAZING_COS = 0.12
NEVER = numpy.inf


@dataclass(frozen=True)
class Solid:
    shape: str  # box, cylinder, vessel (open above), ball; centred, upright in O
    half: tuple  # semi-axes in O, m; round ones: radius, radius, half height
    R_WO: numpy.ndarray
    p_WO: numpy.ndarray
    colour: tuple  # 0 .. 1
    wall_m: float = 0.004  # of a vessel


@dataclass(frozen=True)
class View:
    """The camera above the table's origin; W has z up and the table's surface at 0."""

    tilt_rad: float  # below the horizontal
    distance_m: float  # along its axis to the table
    scale: float = 1.0  # 1: 640 x 480

    @property
    def size(self):
        return round(640 * self.scale), round(480 * self.scale)

    @property
    def focal_px(self):
        return FOCAL_PX * self.scale

    @property
    def height_m(self):
        return self.distance_m * numpy.sin(self.tilt_rad)

    @property
    def aim_y_m(self):
        return self.distance_m * numpy.cos(self.tilt_rad)

    @property
    def R_WC(self):
        c, s = numpy.cos(self.tilt_rad), numpy.sin(self.tilt_rad)
        return numpy.array([[1, 0, 0], [0, -s, c], [0, -c, -s]])

    def rays_C(self):
        """Rows x columns x 3, of depth 1."""
        width, height = self.size
        v, u = numpy.mgrid[:height, :width]
        centre = 0.5 * (width - 1), 0.5 * (height - 1)
        return numpy.stack([(u - centre[0]) / self.focal_px, (v - centre[1]) / self.focal_px, numpy.ones(u.shape)], -1)

    def pixels(self, p_W):
        """Columns and rows of points, n x 2."""
        p_C = (p_W - [0, 0, self.height_m]) @ self.R_WC
        width, height = self.size
        return p_C[:, :2] / p_C[:, 2:] * self.focal_px + [0.5 * (width - 1), 0.5 * (height - 1)]


@dataclass(frozen=True)
class Table:
    """Solids on a table in a room."""

    solids: list
    view: View
    half_width_m: float
    near_m: float  # y of its edges
    far_m: float
    colour: tuple
    seed: int  # of the noise


def write_frame(stem, table):
    """The files that `beckon-capture --render` writes, as far as they are read here; the path of the cloud."""
    from PIL import Image

    depth, labels, rgb = photograph(table)
    rays = table.view.rays_C()
    cloud = stem.with_name(f"{stem.name}.pcd")
    write_pcd(cloud, rays * depth[..., None])
    write_labels(stem.with_name(f"{stem.name}_labels.png"), labels)
    Image.fromarray(rgb).save(stem.with_name(f"{stem.name}_rgb.png"))
    told = {"table": {"normal": list(table.view.R_WC[2]), "offset_m": table.view.height_m}}
    stem.with_name(f"{stem.name}_truth.json").write_text(json.dumps(told))
    return cloud


def photograph(table):
    """Depth (NaN: none), labels and colours, rows x columns."""
    rng = numpy.random.default_rng(table.seed)
    rays_W = table.view.rays_C() @ table.view.R_WC.T
    eye = numpy.array([0, 0, table.view.height_m])
    depth, normals, paint = room(table, eye, rays_W)
    labels = numpy.zeros(depth.shape, numpy.uint16)
    for number, solid in enumerate(table.solids, 1):
        rows, columns = window(table.view, solid)
        if rows.start >= rows.stop or columns.start >= columns.stop:
            continue
        part = rays_W[rows, columns]
        s, normal_O, p_O = hit(solid, (eye - solid.p_WO) @ solid.R_WO, part @ solid.R_WO)
        nearer = s < depth[rows, columns]
        depth[rows, columns][nearer] = s[nearer]
        normals[rows, columns][nearer] = normal_O[nearer] @ solid.R_WO.T
        paint[rows, columns][nearer] = (numpy.array(solid.colour) * pattern(p_O[nearer], number)[:, None])
        labels[rows, columns][nearer] = number
    lamp = numpy.array([0.3, -0.5, 0.8]) / numpy.linalg.norm([0.3, -0.5, 0.8])
    shade = 0.55 + 0.45 * numpy.clip(normals @ lamp, 0, 1)
    rgb = (255 * numpy.clip(paint * shade[..., None] + rng.normal(0, 0.012, depth.shape)[..., None], 0, 1))
    facing = numpy.abs((normals * rays_W).sum(-1)) / numpy.linalg.norm(rays_W, axis=-1)
    measured = measure(depth, facing, table.view, rng)
    return measured, numpy.where(numpy.isfinite(measured), labels, 0), rgb.astype(numpy.uint8)


def room(table, eye, rays_W):
    """Depth, normals and paint of the table's top, the floor and a wall."""
    down = numpy.where(rays_W[..., 2] < 0, -1 / numpy.minimum(rays_W[..., 2], -1e-9), NEVER)
    top = eye[2] * down
    with numpy.errstate(invalid="ignore"):
        p = eye + numpy.where(numpy.isfinite(top), top, 0)[..., None] * rays_W
    on_top = (numpy.isfinite(top) & (numpy.abs(p[..., 0]) < table.half_width_m) & (p[..., 1] > table.near_m)
              & (p[..., 1] < table.far_m))
    floor = (eye[2] + 0.73) * down
    wall = (table.far_m + 0.7) / numpy.maximum(rays_W[..., 1], 1e-9)
    depth = numpy.where(on_top, top, numpy.minimum(floor, wall))
    upright = ~on_top & (wall < floor)
    normals = numpy.where(upright[..., None], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0])
    paint = numpy.where(upright[..., None], [0.8, 0.8, 0.76],
                        numpy.where(on_top[..., None], table.colour, [0.45, 0.4, 0.36]))
    return depth, normals, paint


def window(view, solid):
    corners = numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * solid.half
    pixels = view.pixels(corners @ solid.R_WO.T + solid.p_WO)
    low = numpy.maximum(numpy.floor(pixels.min(0)).astype(int) - 1, 0)
    high = numpy.minimum(numpy.ceil(pixels.max(0)).astype(int) + 2, view.size)
    return slice(low[1], high[1]), slice(low[0], high[0])


def pattern(p_O, number):
    """A print on some of the things; brightness a point."""
    if number % 3:
        return numpy.ones(len(p_O))
    stripes = numpy.floor(p_O @ [30, 22, 38]).astype(int)
    return numpy.where(stripes % 2, 1.0, 0.72)


def hit(solid, o, d):
    """Depth along rays o + s d (NEVER: missed), normal and place, in O."""
    with numpy.errstate(divide="ignore", invalid="ignore"):
        hits = list(HITS[solid.shape](o, d, solid))
    s = numpy.full(d.shape[:2], NEVER)
    normal = numpy.zeros(d.shape)
    for at, is_on, towards in hits:
        at = numpy.where(numpy.isfinite(at) & (at > 0), at, 1e9)
        p = o + at[..., None] * d
        better = is_on(p) & (at < s) & (at < 1e8)
        s[better] = at[better]
        normal[better] = towards(p)[better]
    return s, normal, o + numpy.where(numpy.isfinite(s), s, 0)[..., None] * d


def planes(o, d, axis, at, is_on):
    outwards = numpy.zeros(3)
    outwards[axis] = 1.0 if at > 0 else -1.0
    return (at - o[axis]) / d[..., axis], is_on, lambda p: numpy.broadcast_to(outwards, p.shape)


def roots(a, b, c):
    """Of a s^2 + 2 b s + c; NaN: none."""
    root = numpy.sqrt(b * b - a * c)
    return (-b - root) / a, (-b + root) / a


def around(p):
    return p[..., 0] ** 2 + p[..., 1] ** 2


def mantle(o, d, radius, half, inwards=False):
    flat = numpy.array([1.0, 1.0, 0.0])
    near, far = roots(around(d), (d * (o * flat)).sum(-1), around(o) - radius ** 2)
    sign = -1.0 if inwards else 1.0
    return (far if inwards else near), lambda p: numpy.abs(p[..., 2]) <= half, lambda p: sign * p * flat / radius


def box_hits(o, d, solid):
    half = numpy.array(solid.half)
    for axis in range(3):
        others = [k for k in range(3) if k != axis]
        for side in (-1, 1):
            yield planes(o, d, axis, side * half[axis],
                         lambda p, others=others: (numpy.abs(p[..., others]) <= half[others]).all(-1))


def cylinder_hits(o, d, solid):
    radius, _, half = solid.half
    yield mantle(o, d, radius, half)
    for side in (-1, 1):
        yield planes(o, d, 2, side * half, lambda p: around(p) <= radius ** 2)


def vessel_hits(o, d, solid):
    radius, _, half = solid.half
    inner = radius - solid.wall_m
    yield mantle(o, d, radius, half)
    yield mantle(o, d, inner, half, inwards=True)
    yield planes(o, d, 2, half, lambda p: (around(p) <= radius ** 2) & (around(p) >= inner ** 2))
    s, is_on, _ = planes(o, d, 2, -half + solid.wall_m, lambda p: around(p) <= inner ** 2)
    yield s, is_on, lambda p: numpy.broadcast_to([0.0, 0.0, 1.0], p.shape)


def ball_hits(o, d, solid):
    radius = solid.half[0]
    near, _ = roots((d * d).sum(-1), (d * o).sum(-1), float(o @ o) - radius ** 2)
    yield near, lambda p: numpy.ones(p.shape[:2], bool), lambda p: p / radius


HITS = {"box": box_hits, "cylinder": cylinder_hits, "vessel": vessel_hits, "ball": ball_hits}


def measure(depth, facing, view, rng):
    """What structured light tells of true depths; NaN: nothing."""
    hidden = in_shadow(depth, view)
    kernel = round(3 * view.scale) | 1
    low, high = ndimage.minimum_filter(depth, kernel), ndimage.maximum_filter(depth, kernel)
    edge = high - low > EDGE_M
    chance = rng.random(depth.shape)
    lost = hidden | (edge & (chance < LOST_AT_EDGE)) | (facing < GRAZING_COS)
    between = edge & (chance > 1 - BETWEEN_AT_EDGE)
    z = numpy.where(between, low + (high - low) * rng.random(depth.shape), depth)
    noise = ndimage.gaussian_filter(rng.standard_normal(depth.shape), SMOOTHED_PX * view.scale)
    # Axial noise of a Kinect: C. Nguyen, S. Izadi, D. Lovell, 3DIMPVT 2012.
    z = z + noise / noise.std() * (0.0012 + 0.0019 * (z - 0.4) ** 2)
    scaled = STEPS_PER_PX * FOCAL_PX * BASELINE_M
    z = scaled / numpy.rint(scaled / z)
    return numpy.where(lost | (z > 4) | (z < 0.4), numpy.nan, numpy.round(z, 3))


def in_shadow(depth, view):
    """Whether something stands between a point and the projector, which is on the camera's right."""
    rows, columns = depth.shape
    shift = numpy.rint(view.focal_px * BASELINE_M / depth).astype(int)
    v, u = numpy.indices(depth.shape)
    lit = u - shift + columns  # the projector's column; never negative
    nearest = numpy.full((rows, 2 * columns), NEVER)
    numpy.minimum.at(nearest, (v, lit), depth)
    nearest = ndimage.minimum_filter(nearest, (1, 3))
    return depth > nearest[v, lit] + CLOSE_M
