// What a cloud costs: samples per second of `path`, which scatters in it time and again, against
// the same box filled evenly with as much of the same stuff. Both take turns in one run.
#include <algorithm>
#include <cmath>

#include "benchmarks/report.h"
#include "kaustik/base/parallel.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/material/noise.h"
#include "kaustik/render/session.h"

namespace {

using namespace kaustik;

constexpr int cells = 256, picture = 256, repeats = 31;

/// A round cloud, frayed, with 0 outside of it; its inside is different in every cell.
std::vector<float> cloud() {
  const FractalNoise noise{5, 0.55f, 7};
  std::vector<float> density(size_t(cells) * cells * cells);
  parallel_blocks(cells, 1, [&](size_t begin, size_t end, size_t) {
    for (size_t z = begin; z < end; ++z)
      for (size_t y = 0; y < cells; ++y)
        for (size_t x = 0; x < cells; ++x) {
          const Vec3f p =
              Vec3f(float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f) * (2.0f / cells) -
              Vec3f(1, 1, 1);
          const float inside = 0.75f - length(p) + 0.9f * noise.value(p * 2.5f, 0);
          density[(z * cells + y) * cells + x] = std::max(0.0f, 1.3f * inside);
        }
  });
  return density;
}

/// A camera that looks at the box from −1 to 1, in sun and sky; `medium` fills it.
Description described(const std::string& medium) {
  return parse_mitsuba_xml(fmt::format(R"(<scene version="3.0.0"><integrator type="path"/>
        <sensor type="perspective"><float name="fov" value="38"/><transform name="to_world">
        <lookat origin="1, -4, 1.5" target="0, 0, 0" up="0, 0, 1"/></transform>
        <film type="hdrfilm"><integer name="width" value="{0}"/><integer name="height"
        value="{0}"/></film></sensor>
        <emitter type="constant"><rgb name="radiance" value="0.2, 0.3, 0.5"/></emitter>
        <emitter type="directional"><vector name="direction" value="-1, 1, -2"/>
        <rgb name="irradiance" value="3, 2.8, 2.5"/></emitter>
        <shape type="cube"><bsdf type="null"/>{1}</shape></scene>)",
                                       picture, medium),
                           "cloud", "");
}

class Measured {
 public:
  explicit Measured(const Description& description) : scene_(build_scene(description)) {
    std::vector<std::string> warnings;
    integrator_ = make_integrator(description, *scene_, warnings);
    SplatBuffer splats = SplatBuffer::nowhere();
    state_ = integrator_->prepare(Pass(), splats, {}, {});
  }

  /// One sample of each pixel.
  void sample_picture(uint32_t index) const {
    parallel_blocks(picture, 1, [&](size_t begin, size_t end, size_t) {
      for (size_t y = begin; y < end; ++y)
        for (size_t x = 0; x < picture; ++x) {
          Sampler sampler = Sampler::at(1, 0, Stream::camera, y * picture + x, index);
          SampleSink sink(ComponentSet::all());
          const Vec2f u = sampler.next_2d();
          integrator_->sample(*state_, Vec2f(float(x), float(y)) + u, sampler, sink);
        }
    });
  }

 private:
  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<PassState> state_;
};

/// The description with the grid in place of the volume's file.
Description with_grid(const Description& description, const std::vector<float>& density) {
  for (const Child& child : description.scene->children) {
    if (child.object->family != "shape") continue;
    for (const Child& medium : child.object->children)
      for (const Child& volume : medium.object->children)
        if (volume.object->family == "volume")
          volume.object->properties.push_back(
              {"data", Array::of<float>({cells, cells, cells}, density), {}});
  }
  return description;
}

/// `sigma`: extinction of density 1, 1/m.
void measure(const std::string& name, double sigma, const std::vector<float>& density,
             double mean) {
  const std::string rest = R"(<float name="albedo" value="0.95"/>
      <phase type="hg"><float name="g" value="0.6"/></phase></medium>)";
  const Measured grid(
      with_grid(described(fmt::format(
                    R"(<medium name="interior" type="heterogeneous"><float name="scale" value="{}"/>
          <volume name="sigma_t" type="gridvolume"><transform name="to_world">
          <translate value="-0.5, -0.5, -0.5"/><scale value="2"/></transform></volume>{})",
                    sigma, rest)),
                density));
  const Measured even(described(fmt::format(
      R"(<medium name="interior" type="homogeneous"><float name="sigma_t" value="{}"/>{})",
      sigma * mean, rest)));
  std::vector<double> ratios, of_grid, of_even;
  for (uint32_t i = 0; i <= repeats; ++i) {
    const double even_seconds = bench::seconds_of([&] { even.sample_picture(i); });
    const double grid_seconds = bench::seconds_of([&] { grid.sample_picture(i); });
    if (i == 0) continue;  // caches are warm from here on
    constexpr double samples = double(picture) * picture;
    of_even.push_back(samples / even_seconds);
    of_grid.push_back(samples / grid_seconds);
    ratios.push_back(even_seconds / grid_seconds);
  }
  bench::report(
      fmt::format("cloud_{}_samples_{}", cells, name), bench::median(ratios), "x",
      fmt::format("samples per second in an even box of as much: {:.3g} M/s of {:.3g} M/s; mean "
                  "optical depth of the box {:.3g}",
                  bench::median(of_grid) / 1e6, bench::median(of_even) / 1e6, 2 * sigma * mean),
      {.bar = 0.5});
}

}  // namespace

int main() {
  try {
    const std::vector<float> density = cloud();
    double mean = 0;
    for (const float value : density) mean += double(value);
    mean /= double(density.size());
    measure("thin", 5, density, mean);
    measure("dense", 40, density, mean);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
