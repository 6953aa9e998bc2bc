#include "services/capture/embedded_texture.h"

#include <algorithm>
#include <cmath>

namespace beckon::capture {
namespace {

/// Paints on a texture in pixels; everything is clipped.
class Painter {
 public:
  Painter(int width, int height, const Rgb& base) {
    texture_.width = width;
    texture_.height = height;
    texture_.pixels.assign(static_cast<size_t>(width) * height, base);
  }

  int width() const { return texture_.width; }
  int height() const { return texture_.height; }

  void Rectangle(int x0, int y0, int x1, int y1, const Rgb& colour) {
    for (int y = std::max(0, y0); y < std::min(y1, height()); ++y) {
      for (int x = std::max(0, x0); x < std::min(x1, width()); ++x) At(x, y) = colour;
    }
  }

  void Ellipse(double cx, double cy, double rx, double ry, const Rgb& colour) {
    for (int y = std::max(0, int(cy - ry)); y < std::min(int(cy + ry) + 1, height()); ++y) {
      for (int x = std::max(0, int(cx - rx)); x < std::min(int(cx + rx) + 1, width()); ++x) {
        const double dx = (x - cx) / rx, dy = (y - cy) / ry;
        if (dx * dx + dy * dy < 1) At(x, y) = colour;
      }
    }
  }

  /// A band between two slanted lines, for diagonal designs.
  void Slant(double offset, double thickness, double slope, const Rgb& colour) {
    for (int y = 0; y < height(); ++y) {
      for (int x = 0; x < width(); ++x) {
        const double d = y - slope * x - offset;
        if (d >= 0 && d < thickness) At(x, y) = colour;
      }
    }
  }

  /// Fades the picture towards a colour from top to bottom.
  void Fade(const Rgb& colour, double strength) {
    for (int y = 0; y < height(); ++y) {
      const double a = strength * y / height();
      for (int x = 0; x < width(); ++x) {
        for (int k = 0; k < 3; ++k) {
          At(x, y)[k] = static_cast<uint8_t>(At(x, y)[k] * (1 - a) + colour[k] * a);
        }
      }
    }
  }

  /// A line of letter-like strokes, `size` pixels high.
  void Text(Random& random, int x, int y, int x_end, int size, const Rgb& colour) {
    const int stroke = std::max(1, size / 5);
    const int letter = std::max(2, size * 3 / 5);
    while (x + letter < x_end) {
      if (random.Chance(0.15)) {
        x += letter;
        continue;
      }
      if (random.Chance(0.8)) Rectangle(x, y, x + stroke, y + size, colour);
      if (random.Chance(0.5)) Rectangle(x + letter - stroke, y, x + letter, y + size, colour);
      if (random.Chance(0.5)) Rectangle(x, y, x + letter, y + stroke, colour);
      if (random.Chance(0.5)) {
        Rectangle(x, y + (size - stroke) / 2, x + letter, y + (size + stroke) / 2, colour);
      }
      if (random.Chance(0.5)) Rectangle(x, y + size - stroke, x + letter, y + size, colour);
      x += letter + std::max(1, stroke);
    }
  }

  Rgb& At(int x, int y) { return texture_.pixels[static_cast<size_t>(y) * width() + x]; }
  Texture Take() { return std::move(texture_); }

 private:
  Texture texture_;
};

Rgb FromHsv(double hue, double saturation, double value) {
  Rgb rgb{};
  for (int k = 0; k < 3; ++k) {
    const double n = std::fmod((k == 0 ? 5.0 : k == 1 ? 3.0 : 1.0) + hue * 6, 6.0);
    const double f = std::clamp(std::min(n, 4 - n), 0.0, 1.0);
    rgb[k] = static_cast<uint8_t>(255 * value * (1 - saturation * f));
  }
  return rgb;
}

Rgb Blend(const Rgb& a, const Rgb& b, double t) {
  Rgb out{};
  for (int k = 0; k < 3; ++k) out[k] = static_cast<uint8_t>(a[k] * (1 - t) + b[k] * t);
  return out;
}

/// A picture of things: overlapping patches of related colours.
void PaintPicture(Painter& painter, Random& random, double cx, double cy, double radius) {
  const double hue = random.Unit();
  for (int i = 0, n = random.Int(8, 24); i < n; ++i) {
    const Rgb colour = FromHsv(std::fmod(hue + random.Uniform(0, 0.25), 1.0),
                               random.Uniform(0.3, 0.9), random.Uniform(0.3, 1));
    painter.Ellipse(cx + radius * random.Uniform(-0.8, 0.8),
                    cy + radius * random.Uniform(-0.8, 0.8), radius * random.Uniform(0.08, 0.4),
                    radius * random.Uniform(0.08, 0.4), colour);
  }
}

void PaintBarcode(Painter& painter, Random& random, int x, int y, int size) {
  painter.Rectangle(x, y, x + size, y + size * 2 / 3, {245, 245, 245});
  for (int i = 2; i < size - 2; i += random.Int(2, 4)) {
    painter.Rectangle(x + i, y + 2, x + i + random.Int(1, 2), y + size * 2 / 3 - 2, {20, 20, 20});
  }
}

void PaintWood(Painter& painter, Random& random, const Rgb& light, const Rgb& dark) {
  std::vector<double> grain(painter.height());
  double value = 0.5;
  for (double& g : grain) g = value = std::clamp(value + 0.18 * random.Normal(), 0.0, 1.0);
  const double wave = random.Uniform(2, 12), length = random.Uniform(60, 200);
  for (int y = 0; y < painter.height(); ++y) {
    for (int x = 0; x < painter.width(); ++x) {
      const double shifted = y + wave * std::sin(x / length) + painter.height();
      const double g = grain[static_cast<size_t>(shifted) % grain.size()];
      painter.At(x, y) = Blend(light, dark, std::clamp(g + 0.05 * random.Normal(), 0.0, 1.0));
    }
  }
}

}  // namespace

Eigen::Vector3f Texture::Sample(float u, float v) const {
  const auto at = [&](int x, int y) {
    const Rgb& p = pixels[static_cast<size_t>(y) * width + x];
    return Eigen::Vector3f(p[0], p[1], p[2]);
  };
  if (pixels.size() == 1) return at(0, 0);
  const float x = (u - std::floor(u)) * static_cast<float>(width) - 0.5f;
  const float y = (1 - std::clamp(v, 0.0f, 1.0f)) * static_cast<float>(height) - 0.5f;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const auto column = [&](int c) { return (c + width) % width; };
  const auto row = [&](int r) { return std::clamp(r, 0, height - 1); };
  return (at(column(x0), row(y0)) * (1 - fx) + at(column(x0 + 1), row(y0)) * fx) * (1 - fy) +
         (at(column(x0), row(y0 + 1)) * (1 - fx) + at(column(x0 + 1), row(y0 + 1)) * fx) * fy;
}

Texture PlainTexture(const Rgb& colour) { return {1, 1, {colour}}; }

Rgb PackagingColour(Random& random) {
  const double kind = random.Unit();
  if (kind < 0.2) return FromHsv(random.Unit(), random.Uniform(0, 0.08), random.Uniform(0.85, 1));
  if (kind < 0.28) return FromHsv(random.Unit(), random.Uniform(0, 0.3), random.Uniform(0.05, 0.2));
  if (kind < 0.38) return FromHsv(random.Uniform(0.05, 0.12), random.Uniform(0.3, 0.5), 0.7);
  return FromHsv(random.Unit(), random.Uniform(0.45, 1), random.Uniform(0.4, 0.95));
}

Rgb CrockeryColour(Random& random) {
  const double kind = random.Unit();
  if (kind < 0.5) return FromHsv(random.Unit(), random.Uniform(0, 0.07), random.Uniform(0.8, 1));
  if (kind < 0.75) return FromHsv(random.Unit(), random.Uniform(0.15, 0.4), random.Uniform(0.7, 1));
  return PackagingColour(random);
}

Texture PackagingTexture(Random& random, const Rgb& base, double width_mm, double height_mm) {
  const int w = std::clamp(static_cast<int>(width_mm * 1.2), 24, 480);
  const int h = std::clamp(static_cast<int>(height_mm * 1.2), 24, 400);
  Painter painter(w, h, base);
  const Rgb second = PackagingColour(random), third = PackagingColour(random);
  if (random.Chance(0.4)) painter.Fade(second, random.Uniform(0.3, 1));
  if (random.Chance(0.35)) {
    painter.Slant(random.Uniform(-0.3, 1) * h, random.Uniform(0.1, 0.4) * h, random.Uniform(-1, 1),
                  second);
  }
  for (int i = random.Int(0, 2); i > 0; --i) {
    const int y = random.Int(0, h - 1);
    painter.Rectangle(0, y, w, y + random.Int(h / 20 + 1, h / 4 + 2),
                      random.Chance(0.5) ? second : third);
  }
  // Round packages repeat the design; a flat face has one or two.
  const int repeats = w > 2 * h ? 2 : 1;
  for (int r = 0; r < repeats; ++r) {
    const int x0 = r * w / repeats, x1 = (r + 1) * w / repeats, span = x1 - x0;
    if (random.Chance(0.7)) {
      PaintPicture(painter, random, x0 + span * random.Uniform(0.3, 0.7),
                   h * random.Uniform(0.5, 0.8), std::min(span, h) * random.Uniform(0.2, 0.4));
    }
    if (random.Chance(0.6)) {
      painter.Ellipse(x0 + span * 0.5, h * random.Uniform(0.15, 0.4),
                      span * random.Uniform(0.25, 0.45), h * random.Uniform(0.06, 0.16), third);
    }
    const int title = std::max(4, random.Int(h / 14, h / 6));
    const int top = static_cast<int>(h * random.Uniform(0.1, 0.35));
    const Rgb ink = random.Chance(0.5)   ? Rgb{250, 250, 245}
                    : random.Chance(0.5) ? second
                                         : Rgb{25, 25, 30};
    painter.Text(random, x0 + span / 10, top, x1 - span / 10, title, ink);
    for (int line = 0, lines = random.Int(0, 6), y = random.Int(h / 2, h - 4); line < lines;
         ++line, y += 7) {
      painter.Text(random, x0 + random.Int(2, span / 3 + 2), y, x1 - random.Int(2, span / 3 + 2), 4,
                   ink);
    }
    if (random.Chance(0.3))
      PaintBarcode(painter, random, x0 + random.Int(0, span / 2), random.Int(h / 2, h - 4), 24);
  }
  return painter.Take();
}

Texture CrockeryTexture(Random& random, const Rgb& base) {
  const double kind = random.Unit();
  if (kind < 0.5) return PlainTexture(base);
  Painter painter(300, 120, base);
  const Rgb ink = PackagingColour(random);
  if (kind < 0.65) {
    for (int i = random.Int(1, 3); i > 0; --i) {
      const int y = random.Int(0, 110);
      painter.Rectangle(0, y, 300, y + random.Int(3, 20), ink);
    }
  } else if (kind < 0.8) {
    const int step = random.Int(10, 30);
    for (int y = step / 2; y < 120; y += step) {
      for (int x = step / 2 + (y / step % 2) * step / 2; x < 300; x += step) {
        painter.Ellipse(x, y, step * 0.25, step * 0.25, ink);
      }
    }
  } else if (random.Chance(0.5)) {
    PaintPicture(painter, random, 75, 60, 40);
    PaintPicture(painter, random, 225, 60, 40);
  } else {
    painter.Text(random, 40, random.Int(30, 60), 140, random.Int(12, 30), ink);
  }
  return painter.Take();
}

Texture TableTexture(Random& random) {
  const double kind = random.Unit();
  const Rgb light =
      kind < 0.7
          ? FromHsv(random.Uniform(0.04, 0.1), random.Uniform(0.15, 0.5), random.Uniform(0.6, 0.9))
          : FromHsv(random.Unit(), random.Uniform(0, 0.15), random.Uniform(0.35, 0.9));
  if (kind < 0.6) {
    Painter painter(512, 512, light);
    PaintWood(painter, random, light, Blend(light, {60, 35, 20}, random.Uniform(0.05, 0.3)));
    return painter.Take();
  }
  Painter painter(256, 256, light);
  if (kind > 0.85) {
    const int step = random.Int(16, 64);
    const Rgb other = Blend(light, PackagingColour(random), random.Uniform(0.2, 0.7));
    for (int y = 0; y < 256; y += 2 * step) painter.Rectangle(0, y, 256, y + step, other);
    for (int x = 0; x < 256; x += 2 * step)
      painter.Rectangle(x, 0, x + step, 256, Blend(light, other, 0.5));
  }
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      painter.At(x, y) = Blend(painter.At(x, y), {40, 40, 40}, 0.04 * random.Unit());
    }
  }
  return painter.Take();
}

}  // namespace beckon::capture
