#include "kit/picture.h"

#include <fmt/format.h>

#include "kit/random.h"

namespace kaustik::scenes {

Picture Picture::painted(int width, int height,
                         const std::function<Vec3d(double x, double y)>& color) {
  constexpr int samples = 3;
  Picture picture{width, height, {}};
  const double unit = std::min(width, height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      Vec3d sum(0.0);
      for (int s = 0; s < samples * samples; ++s)
        sum += color((column + (s % samples + 0.5) / samples) / unit,
                     (height - row - (s / samples + 0.5) / samples) / unit);
      picture.pixels.push_back(sum / (samples * samples));
    }
  return picture;
}

std::vector<uint8_t> ppm_bytes(const Picture& picture) {
  const std::string text = fmt::format("P6\n{} {}\n255\n", picture.width, picture.height);
  std::vector<uint8_t> bytes(text.begin(), text.end());
  for (const Vec3d& pixel : picture.pixels)
    for (int i = 0; i < 3; ++i)
      bytes.push_back(uint8_t(std::lround(255 * std::clamp(pixel[i], 0.0, 1.0))));
  return bytes;
}

Vec3d mixed(const Vec3d& a, const Vec3d& b, double t) { return a + (b - a) * t; }

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

namespace {

/// Uneven paint: canvas grain and strokes along x.
double brushwork(double x, double y, uint64_t seed) {
  return 0.05 * fractal_noise({x * 14, y * 60, 0.5}, 3, seed) +
         0.02 * noise({x * 150, y * 150, 0.3}, seed + 9);
}

double ridge_height(double x, double base, double height, double scale, uint64_t seed) {
  return base + height * fractal_noise({x * scale, 0.37, 0.71}, 5, seed);
}

}  // namespace

Picture mountain_lake(int width, int height, uint64_t seed) {
  const auto land = [=](double x, double y) {
    Vec3d c = mixed({0.93, 0.84, 0.68}, {0.38, 0.55, 0.70}, smooth_step(0.45, 1.05, y));
    c += Vec3d(0.16) * smooth_step(0.05, 0.4, fractal_noise({x * 3, y * 7, 0.2}, 4, seed + 40));
    for (int layer = 0; layer < 4; ++layer) {
      const double far = 1 - layer / 3.0;
      const double ridge = ridge_height(x, 0.42 + 0.18 * far, 0.12 + 0.2 * far, 2.2 + layer,
                                        seed + uint64_t(layer) * 7);
      if (y > ridge) continue;
      c = mixed({0.14, 0.22, 0.16}, {0.55, 0.63, 0.70}, far);
      const double snow = smooth_step(0.0, 0.2, fractal_noise({x * 9, y * 5, 0.4}, 4, seed + 3));
      if (layer < 2 && y > 0.58) c = mixed(c, {0.93, 0.93, 0.92}, snow);
    }
    return c;
  };
  return Picture::painted(width, height, [=](double x, double y) {
    constexpr double shore = 0.34;
    Vec3d c;
    if (y > shore) {
      c = land(x, y);
    } else {
      const double ripple = 0.02 * noise({x * 5, y * 70, 0.1}, seed + 50) * (shore - y) / shore * 3;
      c = mixed(land(x + ripple, 2 * shore - y), {0.20, 0.32, 0.36}, 0.42);
    }
    return c + Vec3d(brushwork(x, y, seed));
  });
}

Picture color_fields(int width, int height, uint64_t seed) {
  static const Vec3d grounds[] = {{0.52, 0.10, 0.08}, {0.10, 0.16, 0.30}, {0.80, 0.55, 0.16}};
  static const Vec3d fields[] = {{0.89, 0.42, 0.10}, {0.16, 0.32, 0.52}, {0.62, 0.12, 0.10},
                                 {0.95, 0.76, 0.32}, {0.07, 0.08, 0.16}, {0.78, 0.22, 0.14}};
  Random random(seed);
  const Vec3d ground = grounds[random.index(3)];
  const size_t first = random.index(6);
  const double aspect = double(height) / width, split = random.between(0.5, 0.66);
  return Picture::painted(width, height, [=](double x, double y) {
    const double v = y / std::max(1.0, aspect);
    const double wobble = 0.02 * fractal_noise({x * 7, y * 7, 0.1}, 4, seed + 5);
    const auto inside = [&](double low, double high) {
      const double d = std::min({x - 0.09, 0.91 - x, v - low, high - v}) + wobble;
      return smooth_step(-0.012, 0.03, d);
    };
    const double cloud = 0.5 + 0.5 * fractal_noise({x * 4, y * 6, 0.6}, 5, seed + 11);
    Vec3d c = ground * (0.9 + 0.2 * cloud);
    c = mixed(c, fields[first] * (0.82 + 0.3 * cloud), 0.94 * inside(split + 0.02, 0.94));
    c = mixed(c, fields[(first + 2) % 6] * (0.82 + 0.3 * cloud), 0.94 * inside(0.06, split - 0.03));
    return c + Vec3d(brushwork(x, y, seed));
  });
}

Picture geometric_composition(int width, int height, uint64_t seed) {
  struct Figure {
    Vec3d color;
    Vec2d at;
    double radius, inner;
    Vec2d along;
  };
  static const Vec3d colors[] = {{0.80, 0.16, 0.12}, {0.10, 0.22, 0.48}, {0.93, 0.70, 0.14},
                                 {0.09, 0.09, 0.10}, {0.16, 0.46, 0.40}, {0.90, 0.50, 0.42}};
  Random random(seed);
  std::vector<Figure> figures;
  const double w = double(width) / std::min(width, height),
               h = double(height) / std::min(width, height);
  for (int i = 0; i < 15; ++i) {
    const double angle = random.between(0, pi_d);
    const double radius = random.between(0.04, 0.22) * (i < 4 ? 1.4 : 0.8);
    figures.push_back({colors[random.index(6)],
                       {random.between(0.1, w - 0.1), random.between(0.1, h - 0.1)},
                       radius,
                       random.next() < 0.4 ? radius * random.between(0.5, 0.85) : 0,
                       {std::cos(angle), std::sin(angle)}});
  }
  return Picture::painted(width, height, [=](double x, double y) {
    Vec3d c(0.91, 0.87, 0.77);
    for (size_t i = 0; i < figures.size(); ++i) {
      const Figure& f = figures[i];
      const Vec2d d = Vec2d(x, y) - f.at;
      const double along = std::fabs(d.dot(f.along)), across = std::fabs(f.along.cross(d));
      const bool is_bar = i % 3 == 2;
      const bool hit = is_bar ? along < 2.2 * f.radius && across < 0.012
                              : d.length() < f.radius && d.length() > f.inner;
      if (hit) c = mixed(c, f.color, 0.9);
    }
    return c + Vec3d(brushwork(x, y, seed));
  });
}

Picture seascape_at_dusk(int width, int height, uint64_t seed) {
  const double horizon = 0.42, sun_x = 0.62 * width / std::min(width, height);
  return Picture::painted(width, height, [=](double x, double y) {
    const double glow = std::exp(-12 * ((x - sun_x) * (x - sun_x) + (y - horizon) * (y - horizon)));
    Vec3d c;
    if (y > horizon) {
      c = mixed({0.90, 0.52, 0.28}, {0.18, 0.24, 0.42}, smooth_step(horizon, 1.0, y));
      const double cloud = smooth_step(0.0, 0.35, fractal_noise({x * 2, y * 9, 0.3}, 5, seed));
      c = mixed(c, {0.45, 0.22, 0.26}, 0.7 * cloud);
      c = mixed(c, {1.0, 0.86, 0.56}, glow);
    } else {
      const double near = (horizon - y) / horizon;
      const double wave =
          fractal_noise({x * 6 / (0.2 + near), 12 * std::log(0.05 + near), 0.8}, 4, seed + 8);
      c = mixed({0.38, 0.30, 0.34}, {0.06, 0.12, 0.20}, near);
      const double path = std::exp(-40 * (x - sun_x) * (x - sun_x));
      c = mixed(c, {1.0, 0.74, 0.42}, path * smooth_step(-0.1, 0.3, wave));
      c += Vec3d(0.10) * wave;
    }
    return c + Vec3d(brushwork(x, y, seed));
  });
}

Picture still_life(int width, int height, uint64_t seed) {
  struct Fruit {
    Vec2d at;
    double radius;
    Vec3d color;
  };
  Random random(seed);
  std::vector<Fruit> fruits;
  static const Vec3d colors[] = {
      {0.78, 0.24, 0.12}, {0.85, 0.55, 0.14}, {0.58, 0.62, 0.18}, {0.48, 0.12, 0.20}};
  const double w = double(width) / std::min(width, height);
  for (int i = 0; i < 8; ++i)
    fruits.push_back({{w * (0.2 + 0.085 * i), 0.3 + 0.1 * random.next() * (i % 2)},
                      random.between(0.085, 0.13),
                      colors[random.index(4)]});
  return Picture::painted(width, height, [=](double x, double y) {
    Vec3d c = mixed({0.20, 0.15, 0.11}, {0.36, 0.30, 0.22}, smooth_step(0, 1.2, x + y));
    if (y < 0.28) c = mixed({0.62, 0.55, 0.44}, {0.34, 0.28, 0.22}, smooth_step(0, 1.2, x));
    for (const Fruit& fruit : fruits) {
      const Vec2d d = (Vec2d(x, y) - fruit.at) / fruit.radius;
      if (d.length() > 1) continue;
      const double z = std::sqrt(1 - d.dot(d));
      const double light = std::max(0.0, Vec3d(d.x, d.y, z).dot(Vec3d(-0.55, 0.6, 0.58)));
      c = fruit.color * (0.18 + 0.95 * light) + Vec3d(0.6) * std::pow(light, 40);
    }
    return c + Vec3d(brushwork(x, y, seed));
  });
}

}  // namespace kaustik::scenes
