#include "services/capture/embedded_kinect.h"

#include <algorithm>
#include <cmath>

namespace beckon::capture {
namespace {

/// Disparity changes by more than this from pixel to pixel only across an outline.
constexpr float kOutline_px = 1.2f;

/// Half of a symmetric kernel, the centre first; `squares` receives the sum of squares of all of
/// it.
std::vector<float> GaussianKernel(double sigma_px, double& squares) {
  const int reach = std::max(1, static_cast<int>(std::ceil(2.5 * sigma_px)));
  std::vector<float> kernel(reach + 1);
  double sum = 0;
  for (int i = 0; i <= reach; ++i) {
    const double weight = std::exp(-0.5 * i * i / (sigma_px * sigma_px));
    kernel[i] = static_cast<float>(weight);
    sum += i == 0 ? weight : 2 * weight;
  }
  squares = 0;
  for (int i = 0; i <= reach; ++i) {
    kernel[i] /= static_cast<float>(sum);
    squares += (i == 0 ? 1 : 2) * static_cast<double>(kernel[i]) * kernel[i];
  }
  return kernel;
}

/// Filters along one axis; borders repeat.
template <typename T>
void Filter(std::vector<T>& image, int width, int height, bool along_rows,
            const std::vector<float>& kernel) {
  const int length = along_rows ? width : height, lines = along_rows ? height : width;
  const int stride = along_rows ? 1 : width;
  const int reach = static_cast<int>(kernel.size()) - 1;
  std::vector<T> line(length + 2 * reach);
  for (int l = 0; l < lines; ++l) {
    const size_t start = static_cast<size_t>(l) * (along_rows ? width : 1);
    for (int i = -reach; i < length + reach; ++i) {
      line[i + reach] = image[start + static_cast<size_t>(std::clamp(i, 0, length - 1)) * stride];
    }
    for (int i = 0; i < length; ++i) {
      T sum = line[i + reach] * kernel[0];
      for (int k = 1; k <= reach; ++k)
        sum += (line[i + reach - k] + line[i + reach + k]) * kernel[k];
      image[start + static_cast<size_t>(i) * stride] = sum;
    }
  }
}

/// Averages disparity over the neighbours on the same surface: creases round off, outlines stay.
std::vector<float> SmoothWithinSurfaces(const std::vector<float>& disparity, int width, int height,
                                        double sigma_px) {
  constexpr float kSameSurface_px = 1.0f;
  const int reach = std::max(1, static_cast<int>(std::lround(1.6 * sigma_px)));
  std::vector<float> weights;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      weights.push_back(
          static_cast<float>(std::exp(-0.5 * (x * x + y * y) / (sigma_px * sigma_px))));
    }
  }
  std::vector<float> smooth(disparity.size(), 0.0f);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const size_t at = static_cast<size_t>(v) * width + u;
      if (disparity[at] <= 0) continue;
      float sum = 0, weight = 0;
      size_t k = 0;
      for (int y = v - reach; y <= v + reach; ++y) {
        for (int x = u - reach; x <= u + reach; ++x, ++k) {
          if (x < 0 || x >= width || y < 0 || y >= height) continue;
          const float d = disparity[static_cast<size_t>(y) * width + x];
          if (d <= 0 || std::abs(d - disparity[at]) > kSameSurface_px) continue;
          sum += weights[k] * d;
          weight += weights[k];
        }
      }
      smooth[at] = sum / weight;
    }
  }
  return smooth;
}

/// Disparity beside a pixel changes by more than a surface does.
bool AtOutline(const std::vector<float>& disparity, int width, int height, int u, int v) {
  const float d = disparity[static_cast<size_t>(v) * width + u];
  for (int y = std::max(0, v - 1); y <= std::min(height - 1, v + 1); ++y) {
    for (int x = std::max(0, u - 1); x <= std::min(width - 1, u + 1); ++x) {
      if (std::abs(disparity[static_cast<size_t>(y) * width + x] - d) > kOutline_px) return true;
    }
  }
  return false;
}

/// The depth beside a pixel that differs most from its own.
float AcrossOutline(const std::vector<float>& disparity, int width, int height, int u, int v) {
  const float d = disparity[static_cast<size_t>(v) * width + u];
  float across = d;
  for (int y = std::max(0, v - 1); y <= std::min(height - 1, v + 1); ++y) {
    for (int x = std::max(0, u - 1); x <= std::min(width - 1, u + 1); ++x) {
      const float other = disparity[static_cast<size_t>(y) * width + x];
      if (other > 0 && std::abs(other - d) > std::abs(across - d)) across = other;
    }
  }
  return across;
}

/// The value below which a unit normal falls with the given probability (logistic approximation).
float Quantile(double probability) {
  const double p = std::clamp(probability, 1e-4, 1 - 1e-4);
  return static_cast<float>(std::log(p / (1 - p)) / 1.702);
}

/// What each pixel of the depth image looks at: itself, or, near an outline, what lies on its other
/// side.
std::vector<size_t> StrayedPixels(const Rendering& rendering, const DepthNoise& noise,
                                  Random& random) {
  const int w = rendering.window.width, h = rendering.window.height;
  const auto du = SmoothNoise(w, h, 2.2, 2.2, random), dv = SmoothNoise(w, h, 2.2, 2.2, random);
  std::vector<size_t> source(rendering.window.Size());
  for (int v = 0; v < h; ++v) {
    for (int u = 0; u < w; ++u) {
      const size_t at = static_cast<size_t>(v) * w + u;
      const int x =
          std::clamp(u + static_cast<int>(std::lround(noise.ragged_px * du[at])), 0, w - 1);
      const int y =
          std::clamp(v + static_cast<int>(std::lround(noise.ragged_px * dv[at])), 0, h - 1);
      const size_t other = static_cast<size_t>(y) * w + x;
      const float here = rendering.depth_m[at], there = rendering.depth_m[other];
      const bool same = here > 0 && there > 0 &&
                        std::abs(1 / here - 1 / there) * noise.baseline_focal_m_px < kOutline_px;
      source[at] = same ? at : other;
    }
  }
  return source;
}

/// Probability that a surface returns too little of the pattern.
double SurfaceDropout(float incidence, float metal, float brightness) {
  const double grazing = std::clamp((0.22 - incidence) / 0.16, 0.0, 1.0);
  const double mirror = metal * (0.4 + 1.2 * std::abs(incidence - 0.5));
  const double black = 0.12 * std::clamp((35.0 - brightness) / 35.0, 0.0, 1.0);
  return std::max({grazing, black, std::min(0.9, mirror)});
}

}  // namespace

std::vector<float> SmoothNoise(int width, int height, double sigma_u_px, double sigma_v_px,
                               Random& random) {
  std::vector<float> noise(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (float& value : noise) value = random.Normal();
  double squares_u = 1, squares_v = 1;
  if (sigma_u_px > 0.3) Filter(noise, width, height, true, GaussianKernel(sigma_u_px, squares_u));
  if (sigma_v_px > 0.3) Filter(noise, width, height, false, GaussianKernel(sigma_v_px, squares_v));
  const auto scale = static_cast<float>(1 / std::sqrt(squares_u * squares_v));
  for (float& value : noise) value *= scale;
  return noise;
}

DepthNoise RandomKinectNoise(Random& random) {
  DepthNoise noise;
  const double strength = random.Uniform(0.75, 1.15);
  noise.sigma_px *= strength * random.Uniform(0.85, 1.15);
  noise.coarse_sigma_px *= strength * random.Uniform(0.85, 1.15);
  noise.coarse_correlation_u_px *= random.Uniform(0.8, 1.25);
  noise.coarse_correlation_v_px *= random.Uniform(0.8, 1.25);
  noise.smoothing_px = random.Uniform(2.1, 3.2);
  noise.ragged_px = random.Uniform(0.5, 1.2);
  noise.edge_dropout = random.Uniform(0.0, 0.12);
  noise.shadow_dropout = random.Uniform(0.1, 0.7);
  return noise;
}

// Of the Kinect's noise all but its loss at outlines is measured; the other cameras' is drawn wide,
// so that what learns from it leans on none.
DepthCamera RandomDepthCamera(Random& random) {
  DepthCamera camera;
  const double kind = random.Unit();
  double focal_px = random.Uniform(515, 585);
  if (kind < 0.55) {
    camera.noise = RandomKinectNoise(random);
    camera.noise.edge_dropout =
        random.Uniform(0.02, 0.35);  // segmentation leaves some of it as well
  } else if (kind <
             0.78) {  // time of flight: no pattern, so no steps and no shadow, but mixed pixels
    DepthNoise& noise = camera.noise;
    focal_px = random.Uniform(345, 560);
    noise.sigma_px = random.Uniform(0.02, 0.06);
    noise.coarse_sigma_px = random.Uniform(0.01, 0.04);
    noise.step_px = 0.005;
    noise.smoothing_px = random.Uniform(0.4, 0.9);
    noise.ragged_px = random.Uniform(0.3, 0.7);
    noise.edge_dropout = random.Uniform(0.0, 0.25);
    noise.shadow_dropout = 0;
    noise.flying = random.Uniform(0.1, 0.6);
  } else {  // active stereo: a short base, wide windows
    DepthNoise& noise = camera.noise;
    focal_px = random.Uniform(385, 625);
    noise.baseline_focal_m_px = 0.05 * focal_px;
    noise.sigma_px = random.Uniform(0.01, 0.03);
    noise.coarse_sigma_px = random.Uniform(0.02, 0.06);
    noise.coarse_correlation_u_px = random.Uniform(2.5, 6);
    noise.coarse_correlation_v_px = random.Uniform(2.5, 6);
    noise.step_px = 0.03125;
    noise.smoothing_px = random.Uniform(1.2, 2.6);
    noise.ragged_px = random.Uniform(0.7, 1.6);
    noise.edge_dropout = random.Uniform(0.0, 0.15);
    noise.shadow_dropout = random.Uniform(0.1, 0.7);
  }
  camera.intrinsics = {focal_px, focal_px, 319.5 + random.Uniform(-8, 8),
                       239.5 + random.Uniform(-8, 8)};
  return camera;
}

KinectDepth SimulateDepth(const Rendering& rendering, const DepthNoise& noise, Random& random) {
  const Window& window = rendering.window;
  const int w = window.width, h = window.height;
  const auto source = StrayedPixels(rendering, noise, random);
  const auto product = static_cast<float>(noise.baseline_focal_m_px);
  std::vector<float> disparity(window.Size(), 0.0f);
  for (size_t i = 0; i < disparity.size(); ++i) {
    const float depth = rendering.depth_m[source[i]];
    if (depth > 0) disparity[i] = product / depth;
  }
  const auto smooth = SmoothWithinSurfaces(disparity, w, h, noise.smoothing_px);
  const auto fine = SmoothNoise(w, h, noise.correlation_u_px, noise.correlation_v_px, random);
  const auto coarse =
      SmoothNoise(w, h, noise.coarse_correlation_u_px, noise.coarse_correlation_v_px, random);
  const auto blotches = SmoothNoise(w, h, 1.6, 1.6, random);
  const float shadow_limit = noise.shadow_dropout > 0 ? Quantile(noise.shadow_dropout) : -1e9f,
              edge_limit = Quantile(noise.edge_dropout);
  KinectDepth out;
  out.depth_m.assign(window.Size(), 0.0f);
  out.labels.assign(window.Size(), 0);
  for (int v = 0; v < h; ++v) {
    for (int u = 0; u < w; ++u) {
      const size_t i = static_cast<size_t>(v) * w + u, s = source[i];
      if (smooth[i] <= 0) continue;
      if (rendering.unlit[s] && blotches[i] < shadow_limit) continue;
      const double lost =
          SurfaceDropout(rendering.incidence[s], rendering.metal[s], rendering.colour[s].mean());
      if (lost > 0.02 && blotches[i] < Quantile(lost)) continue;
      const bool at_outline = AtOutline(disparity, w, h, u, v);
      if (blotches[i] < edge_limit && at_outline) continue;
      double seen = smooth[i];
      if (at_outline && noise.flying > 0 && random.Chance(noise.flying)) {
        seen += random.Unit() * (AcrossOutline(disparity, w, h, u, v) - seen);
      }
      const double noisy = seen + noise.sigma_px * fine[i] + noise.coarse_sigma_px * coarse[i];
      const double stepped = std::round(noisy / noise.step_px) * noise.step_px;
      if (!(stepped > 4)) continue;  // beyond 10 m
      out.depth_m[i] = static_cast<float>(std::round(1000 * product / stepped) / 1000);
      out.labels[i] = rendering.labels[s];
    }
  }
  return out;
}

std::vector<Rgb> SimulateColour(const Rendering& rendering, Random& random) {
  const int w = rendering.window.width, h = rendering.window.height;
  std::vector<Eigen::Vector3f> colour = rendering.colour;
  double squares = 0;
  const auto kernel = GaussianKernel(random.Uniform(0.55, 0.85), squares);
  Filter(colour, w, h, true, kernel);
  Filter(colour, w, h, false, kernel);
  const auto sigma = static_cast<float>(random.Uniform(1.0, 3.5));
  std::vector<Rgb> image(colour.size());
  for (size_t i = 0; i < image.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      image[i][k] =
          static_cast<uint8_t>(std::clamp(colour[i][k] + sigma * random.Normal(), 0.0f, 255.0f));
    }
  }
  return image;
}

}  // namespace beckon::capture
