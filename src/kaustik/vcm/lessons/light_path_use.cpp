#include "kaustik/vcm/lessons/light_path_use.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/photon/coverage/merge_disk.h"
#include "kaustik/transport/direct_light.h"
#include "kaustik/vcm/lessons/probe_light.h"
#include "kaustik/vcm/lessons/radius_learning.h"

namespace kaustik {
namespace {

/// Probes that there are at most, or a few more.
constexpr double most_probes = 1024;
constexpr int usual_least_block = 4;
constexpr int direct_samples = 4;
/// Of the mean over the probes: light that counts where there is less. What is dark may be noisy.
constexpr double least_light = 0.05;
/// Boxes that the probes are put into.
constexpr size_t most_targets = 32;

int block_size(const Vec2i& pixels, int least_block) {
  const double each = double(pixels.x) * double(pixels.y) / most_probes;
  return std::max(least_block, int(std::ceil(std::sqrt(each))));
}

float direct_light_at(const Scene& scene, const SurfaceVertex& vertex, uint64_t probe) {
  Sampler sampler = Sampler::at(0, 0, Stream::direct_probe, probe, 0);
  uint64_t rays = 0;
  const auto reflect = [&](const DirectLight& light, ShadowAnswer& answer) {
    const Spectrum reflected = vertex.eval_cosine(light.wi, Lobes::all);
    if (reflected.is_zero()) return Spectrum();
    const Medium* medium = vertex.medium_toward(light.wi, nullptr);
    return reflected * light.radiance *
           trace_shadow_ray(scene, light, medium, {vertex.wavelengths(), sampler}, rays, answer);
  };
  return sample_direct_lights<Spectrum>(scene, Receiver(vertex, 1),
                                        {LightChoice::one, direct_samples}, sampler, reflect)
      .sum();
}

/// At most `count` boxes with about as many of the points in each.
std::vector<AimTarget> boxes_around(std::vector<Vec3f> points, size_t count) {
  struct Range {
    size_t begin, end;
  };
  std::vector<Range> ranges;
  if (!points.empty()) ranges.push_back({0, points.size()});
  const auto bounds_of = [&](const Range& range) {
    Bounds3f box;
    for (size_t i = range.begin; i < range.end; ++i) box.extendBy(points[i]);
    return box;
  };
  while (!ranges.empty() && 2 * ranges.size() <= count) {
    std::vector<Range> halves;
    for (const Range& range : ranges) {
      const size_t middle = (range.begin + range.end) / 2;
      if (middle == range.begin) {
        halves.push_back(range);
        continue;
      }
      const int axis = int(bounds_of(range).majorAxis());
      const auto at = [&](size_t i) { return points.begin() + std::ptrdiff_t(i); };
      std::nth_element(at(range.begin), at(middle), at(range.end),
                       [axis](const Vec3f& a, const Vec3f& b) { return a[axis] < b[axis]; });
      halves.push_back({range.begin, middle});
      halves.push_back({middle, range.end});
    }
    if (halves.size() == ranges.size()) break;
    ranges = std::move(halves);
  }
  std::vector<AimTarget> targets;
  for (const Range& range : ranges) targets.push_back({bounds_of(range), 1, 0});
  return targets;
}

}  // namespace

LightPathUse::LightPathUse(const Scene& scene, const LightPathEmission& plain, ComponentSet wanted)
    : light_count_(scene.lights().size()), wanted_(wanted), emission_(plain) {
  // What merges in a crop window comes from around it, too. Guides that knew the window alone left
  // it darker.
  const FilmSettings& film = scene.film();
  const bool are_apart = scene.camera().traits().are_pixels_apart();
  const int block = block_size(film.crop_size, are_apart ? 1 : usual_least_block);
  const int margin = int(std::ceil(RadiusLearning::widest_widths() / float(block)));
  reach_ = 0.5f * float(block);
  probes_ = make_pixel_probes(scene, BlockGrid(PlanWindow(film, block, margin), block));
  direct_.resize(probes_.size());
  arrived_.resize(probes_.size());
  parallel_blocks(probes_.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t p = begin; p < end; ++p)
      if (probes_[p].found && wanted_.has(probes_[p].path.component_after(Lobes::diffuse)))
        direct_[p] = direct_light_at(scene, probes_[p].vertex, p);
  });
}

std::vector<AimTarget> LightPathUse::targets() const {
  std::vector<Vec3f> points;
  for (const PixelProbe& probe : probes_) {
    if (!probe.found) continue;
    points.push_back(probe.vertex.position());
    if (probe.gauge < 0) continue;
    // Its disk, which no other probe stands for.
    const Vec3f reach(GaugeDisks::largest_radius(probe.distance));
    points.push_back(probe.vertex.position() - reach);
    points.push_back(probe.vertex.position() + reach);
  }
  return boxes_around(std::move(points), most_targets);
}

std::vector<LightPathUse::Arrival> LightPathUse::arrivals(const LightVertices& light,
                                                          const std::stop_token& stop) const {
  const uint32_t last_path = light.beginnings.back().path;
  constexpr size_t per_block = 16;
  std::vector<std::vector<Arrival>> found((probes_.size() + per_block - 1) / per_block);
  parallel_blocks(probes_.size(), per_block, [&](size_t begin, size_t end, size_t block) {
    for (size_t p = begin; p < end && !stop.stop_requested(); ++p) {
      const PixelProbe& probe = probes_[p];
      if (!probe.found) continue;
      const ProbeLight at_probe(probe, wanted_, light.wavelengths);
      const auto arrive = [&](const LightVertexData& photon, float value) {
        if (value > 0)
          found[block].push_back({uint32_t(p), photon.path, photon.path + photon.before, value});
      };
      if (probe.gauge >= 0) {
        const auto vertices = light.at_gauges.of(size_t(probe.gauge));
        if (vertices.empty()) continue;
        const float radius_sq = sqr(light.at_gauges.disks().radius(size_t(probe.gauge)));
        for (const GaugeVertex& vertex : vertices)
          if (vertex.data.path <= last_path && vertex.offset_sq < radius_sq)
            arrive(vertex.data, at_probe.sent(vertex.data) * inv_pi / radius_sq);
        continue;
      }
      const float radius = reach_ * probe.pixel_width;
      if (!(radius > 0)) continue;
      const MergeDisk disk(probe.vertex, radius);
      light.tree.within(
          probe.vertex.position(), disk.side(), false, sqr(radius), [&](uint32_t index, float) {
            const LightVertexData& photon = light.tree.tree().data(index);
            if (photon.path > last_path) return;
            const Vec3f offset = light.tree.tree().key(index) - probe.vertex.position();
            arrive(photon,
                   at_probe.sent(photon) * disk.share(offset, photon.side) * inv_pi / sqr(radius));
          });
    }
  });
  std::vector<Arrival> result;
  if (stop.stop_requested()) return result;
  for (const auto& of_block : found) result.insert(result.end(), of_block.begin(), of_block.end());
  return result;
}

std::vector<double> LightPathUse::totals(double floor) const {
  std::vector<double> result(probes_.size());
  double sum = 0, count = 0;
  for (size_t p = 0; p < probes_.size(); ++p) {
    result[p] = double(direct_[p]) + arrived_[p] / paths_;
    if (probes_[p].found) sum += result[p], ++count;
  }
  for (double& total : result) total += count > 0 ? floor * sum / count : 0.0;
  return result;
}

double LightPathUse::use_of(const Arrival& arrival, const std::vector<double>& totals,
                            double paths) {
  const double total = totals[arrival.probe];
  return total > 0 ? std::min(double(arrival.light) / total, paths) : 0.0;
}

std::vector<double> LightPathUse::squared_uses(const Seen& seen) const {
  const std::vector<double> total = totals(least_light);
  std::vector<double> squares;
  for (const Arrival& arrival : seen.arrivals) {
    if (squares.size() <= arrival.vertex) squares.resize(size_t(arrival.vertex) + 1);
    squares[arrival.vertex] += sqr(use_of(arrival, total, double(seen.paths)));
  }
  size_t end = squares.size();
  for (size_t i = seen.beginnings.size(); i-- > 0;) {
    const size_t begin = seen.beginnings[i].path;
    for (size_t v = end; v-- > begin + 1;) squares[v - 1] += squares[v];
    end = std::min(end, begin);
  }
  return squares;
}

LightPathUse::Noise LightPathUse::noise_of(const Seen& seen) const {
  // Density of each vertex over what it were if nothing was guided.
  std::vector<float> ratio(size_t(seen.beginnings.back().path) + 1, 1.0f);
  for (const LightScattering& event : seen.scatterings) {
    const size_t next = size_t(event.path) + event.at + 1;
    if (ratio.size() <= next) ratio.resize(next + 1, 1.0f);
    ratio[next] = event.pdf / event.pdf_unguided;
  }
  const std::vector<double> total = totals(1);
  Noise sum;
  for (const Arrival& arrival : seen.arrivals) {
    const double square = sqr(use_of(arrival, total, double(seen.paths)));
    sum.guided += square;
    double unguided = square;
    for (size_t v = arrival.path; v <= arrival.vertex && v < ratio.size(); ++v)
      unguided *= double(ratio[v]);
    sum.unguided += unguided;
  }
  return sum;
}

LightPathUse::Seen LightPathUse::seen_in(const LightVertices& light,
                                         const std::stop_token& stop) const {
  Seen seen;
  seen.paths = light.remembered_paths;
  if ((light.tree.empty() && light.at_gauges.empty()) || light.beginnings.empty()) return seen;
  seen.arrivals = arrivals(light, stop);
  if (stop.stop_requested()) return seen;
  seen.beginnings = light.beginnings;
  seen.scatterings = light.scatterings;
  return seen;
}

std::vector<double> LightPathUse::look_at(const Seen& seen) {
  paths_ += double(seen.paths);
  noise_ = {};
  if (seen.beginnings.empty()) return {};
  for (const Arrival& arrival : seen.arrivals) arrived_[arrival.probe] += double(arrival.light);
  noise_ = noise_of(seen);
  return squared_uses(seen);
}

void LightPathUse::learn_scattering(const LightVertices& light, const std::stop_token& stop) {
  const Seen seen = seen_in(light, stop);
  if (stop.stop_requested()) return;
  learn_scattering(seen, look_at(seen));
}

void LightPathUse::learn_scattering(const Seen& seen, const std::vector<double>& squares) {
  std::vector<std::pair<const LightScattering*, double>> events;
  for (const LightScattering& event : seen.scatterings)
    if (const size_t next = size_t(event.path) + event.at + 1;
        next < squares.size() && squares[next] > 0)
      events.emplace_back(&event, std::sqrt(squares[next]));
  constexpr size_t most = ScatterLearning::most_events_of_lesson;
  const size_t step = (events.size() + most - 1) / most;
  for (size_t i = 0; i < events.size(); i += step)
    scattering_.add(*events[i].first, events[i].second, double(step));
}

void LightPathUse::learn(const LightVertices& light, const std::stop_token& stop) {
  const Seen seen = seen_in(light, stop);
  if (!stop.stop_requested()) learn(seen);
}

void LightPathUse::learn(const Seen& seen) {
  const std::vector<double> squares = look_at(seen);
  for (const LightPathBeginning& beginning : seen.beginnings)
    if (beginning.path < squares.size() && squares[beginning.path] > 0)
      emission_.add(beginning.start, std::sqrt(squares[beginning.path]));
  learn_scattering(seen, squares);
}

}  // namespace kaustik
