#pragma once
// Small pictures whose pixels are known: in closed form, or by what has no bias and many samples.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/geometry/ray.h"
#include "kaustik/integrator/make_integrator.h"
#include "kaustik/scene/scene.h"

namespace kaustik::bench {

/// What finds some components without bias, and how many samples per pixel that takes.
struct TruthPart {
  std::string integrator, components;
  uint32_t samples;
};

/// A scene in a square picture of `size` pixels.
struct CoverageScene {
  std::string name;
  int size;
  /// Of a scene that is known in closed form: its file, and the luminance that a ray from the
  /// camera finds. Other scenes ship.
  std::string text;
  std::function<double(const Ray&)> radiance;
  /// Of one that ships.
  std::vector<TruthPart> truth;
  bool is_analytic() const { return radiance != nullptr; }
  size_t pixel_count() const { return size_t(size) * size_t(size); }
};
const std::vector<CoverageScene>& coverage_scenes();

/// One of them with an integrator, which finds `components` only, if they are not empty.
struct CoverageSetup {
  CoverageSetup(const CoverageScene& of, const std::string& type,
                const std::string& components = "");
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<Integrator> integrator;
};

/// Of a pixel's luminance; the variance is that of what is known.
struct KnownPixel {
  double mean = 0, variance = 0;
};
std::vector<KnownPixel> truth_of(const CoverageScene& of);

}  // namespace kaustik::bench
