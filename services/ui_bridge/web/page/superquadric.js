// Lines on the visible side of a superquadric, projected into the camera's image. Pure.
// Surface: Solina and Bajcsy, "Recovery of parametric models from range images", 1990, eq. 2 (the
// spherical product of two superellipses) with their linear tapering along z, eq. 9.

const AROUND = 24;  // steps of the equator
const ALONG = 12;   // steps from pole to pole

/** The point of a superellipse |x|^(2/e) + |y|^(2/e) = 1 in direction `angle`: unlike equal steps of
 * its usual parameter, equal steps of the direction are spread over edges and corners alike. */
function superellipse(angle, e) {
  const x = Math.cos(angle);
  const y = Math.sin(angle);
  const exponent = 2 / Math.max(e, 0.05);
  const largest = Math.max(Math.abs(x), Math.abs(y));
  const sum = Math.abs(x / largest) ** exponent + Math.abs(y / largest) ** exponent;
  const r = 1 / (largest * sum ** (1 / exponent));
  return [r * x, r * y];
}

/** v turned by the unit quaternion [w, x, y, z]. */
export function rotate([w, x, y, z], [a, b, c]) {
  const u = [y * c - z * b, z * a - x * c, x * b - y * a];
  return [
    a + 2 * (w * u[0] + y * u[2] - z * u[1]),
    b + 2 * (w * u[1] + z * u[0] - x * u[2]),
    c + 2 * (w * u[2] + x * u[1] - y * u[0]),
  ];
}

/** The surface at latitude `eta` (-pi/2 .. pi/2) and longitude `omega`, in the camera's frame. */
export function surfacePoint(shape, eta, omega) {
  const [a1, a2, a3] = shape.semi_axes;
  const [c, s] = superellipse(eta, shape.epsilon[0]);
  const [x, y] = superellipse(omega, shape.epsilon[1]);
  const [kx, ky] = shape.taper ?? [0, 0];
  const local = [a1 * c * x * (kx * s + 1), a2 * c * y * (ky * s + 1), a3 * s];
  return rotate(shape.rotation_C, local).map((value, i) => value + shape.position_C[i]);
}

/** Pixels of a point of the camera's frame; null behind the camera. */
export function project([x, y, z], { fx, fy, cx, cy }) {
  return z > 0.01 ? [(fx * x) / z + cx, (fy * y) / z + cy] : null;
}

function projectGrid(shape, intrinsics) {
  const grid = [];
  for (let i = 0; i <= ALONG; ++i) {
    const row = [];
    for (let j = 0; j <= AROUND; ++j) {
      const eta = Math.PI * (i / ALONG - 0.5);
      const point = project(surfacePoint(shape, eta, (2 * Math.PI * j) / AROUND), intrinsics);
      if (point === null) return null;
      row.push(point);
    }
    grid.push(row);
  }
  return grid;
}

/** Twice the area of a patch in the image; negative where it faces the camera (y points down). */
function signedArea(a, b, c, d) {
  return (c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0]);
}

/** Lines, each a list of [u, v]; none where it is not wholly in front of the camera. Every second
 * meridian and parallel is drawn, where one of the patches beside it faces the camera. */
export function wireframe(shape, intrinsics) {
  const grid = projectGrid(shape, intrinsics);
  if (grid === null) return [];
  const faces = (i, j) => {
    if (i < 0 || i >= ALONG) return false;
    const k = (j + AROUND) % AROUND;
    const area = signedArea(grid[i][k], grid[i][k + 1], grid[i + 1][k + 1], grid[i + 1][k]);
    return area < 0;
  };
  const lines = [];
  for (let i = 0; i <= ALONG; i += 2) {
    for (let j = 0; j < AROUND; ++j) {
      if (faces(i, j) || faces(i - 1, j)) lines.push([grid[i][j], grid[i][j + 1]]);
    }
  }
  for (let j = 0; j < AROUND; j += 2) {
    for (let i = 0; i < ALONG; ++i) {
      if (faces(i, j) || faces(i, j - 1)) lines.push([grid[i][j], grid[i + 1][j]]);
    }
  }
  return lines;
}
