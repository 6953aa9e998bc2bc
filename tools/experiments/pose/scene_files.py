"""Organised scenes and their labels: PCD read and written, label images written."""

import ctypes
import ctypes.util
import struct

import numpy

from lab import LabError


def read_pcd(path):
    """Fields of every point as a structured array, rows x columns."""
    content = path.read_bytes()
    start = content.index(b"\nDATA ") + 1
    end = content.index(b"\n", start)
    header = dict(line.split(maxsplit=1) for line in content[:start].decode().splitlines() if line[:1] not in ("#", ""))
    kinds = [kind.lower() + size for kind, size in zip(header["TYPE"].split(), header["SIZE"].split())]
    layout = numpy.dtype(list(zip(header["FIELDS"].split(), kinds)))
    shape = int(header["HEIGHT"]), int(header["WIDTH"])
    count, body = shape[0] * shape[1], content[end + 1:]
    coding = content[start:end].decode().split()[1]
    if coding == "binary":
        return numpy.frombuffer(body, layout, count).reshape(shape)
    if coding != "binary_compressed":
        raise LabError(f"{path}: expected DATA binary or binary_compressed, found {coding}")
    packed, size = struct.unpack("<II", body[:8])
    raw, points, offset = decompress(body[8:8 + packed], size, path), numpy.zeros(count, layout), 0
    for name in layout.names:  # a field after the other
        points[name] = numpy.frombuffer(raw, layout[name], count, offset)
        offset += layout[name].itemsize * count
    return points.reshape(shape)


def decompress(packed, size, path):
    name = ctypes.util.find_library("lzf")
    if name is None:
        raise LabError("there is no liblzf, which compressed PCD needs; install liblzf1")
    raw = ctypes.create_string_buffer(size)
    if ctypes.CDLL(name).lzf_decompress(packed, len(packed), raw, size) != size:
        raise LabError(f"{path}: is damaged")
    return raw.raw


def positions(points):
    """Of the array `read_pcd` gives: rows x columns x 3, m."""
    return numpy.stack([points[axis] for axis in "xyz"], -1).astype(float)


def write_pcd(path, p):
    """Positions, rows x columns x 3, as an organised cloud."""
    rows, columns, _ = p.shape
    path.write_bytes(f"""\
VERSION 0.7
FIELDS x y z
SIZE 4 4 4
TYPE F F F
COUNT 1 1 1
WIDTH {columns}
HEIGHT {rows}
VIEWPOINT 0 0 0 1 0 0 0
POINTS {rows * columns}
DATA binary
""".encode() + p.astype("<f4").tobytes())


def write_labels(path, labels):
    """A 16-bit grey PNG."""
    from PIL import Image

    Image.fromarray(labels.astype(numpy.uint16)).save(path)


def fit_plane(points, rng, inlier_m=0.008):
    """Unit normal towards the origin and offset, n·p + d = 0: the best of random triples, then least squares."""
    best = (0, None, None)
    for _ in range(200):
        a, b, c = points[rng.integers(0, len(points), 3)]
        normal = numpy.cross(b - a, c - a)
        length = numpy.linalg.norm(normal)
        if length < 1e-9:
            continue
        normal /= length
        votes = numpy.sum(numpy.abs((points[::17] - a) @ normal) < inlier_m)
        best = max(best, (votes, normal, -normal @ a), key=lambda found: found[0])
    _, normal, offset = best
    for _ in range(5):
        near = points[numpy.abs(points @ normal + offset) < inlier_m]
        middle = near.mean(0)
        normal = numpy.linalg.eigh(numpy.cov((near - middle).T))[1][:, 0]
        offset = -normal @ middle
    return (normal, offset) if offset > 0 else (-normal, -offset)
