#include "kaustik/irradiance/hemisphere.h"

#include "kaustik/base/to_integer.h"
#include "kaustik/irradiance/cell_mesh.h"

namespace kaustik {
namespace {

/// Importance as it may be used: finite, not negative; false if nothing is left of it.
bool clean_importance(size_t cells, std::vector<float>& importance) {
  importance.resize(cells, 0.0f);
  double total = 0;
  for (float& value : importance) {
    if (!(value > 0) || !std::isfinite(value)) value = 0;
    total += value;
  }
  return total > 0 && std::isfinite(total);
}

/// One sample for each cell, and `extra` more in proportion to `importance` by systematic sampling
/// with the offset `u` in [0, 1).
std::vector<uint32_t> samples_per_cell(const std::vector<float>& importance, int extra, float u) {
  std::vector<uint32_t> counts(importance.size(), 1);
  double total = 0;
  for (const float value : importance) total += value;
  double running = 0;
  int64_t placed = 0;
  for (size_t cell = 0; cell < counts.size(); ++cell) {
    running += importance[cell];
    const auto until = std::min<int64_t>(extra, int64_t(running / total * extra + u));
    if (until > placed) counts[cell] += uint32_t(until - placed), placed = until;
  }
  return counts;
}

struct Plan {
  HemisphereGrid grid;
  std::vector<uint32_t> counts;
};

/// Where the samples go. Without known importance all of them are spread evenly.
Plan plan_samples(const RadianceSource& source, const SurfacePoint& at, const Frame& frame,
                  const HemisphereSettings& settings, float u, Scratch& scratch) {
  const int samples = std::max(1, settings.samples);
  const float share = std::clamp(settings.importance_share, 0.0f, 1.0f);
  Plan plan;
  std::vector<float> importance;
  if (share > 0) {
    plan.grid = HemisphereGrid::for_samples(to_integer(float(samples) * (1 - share), 1, samples));
    if (source.importance(at, frame, plan.grid, scratch, importance) &&
        clean_importance(size_t(plan.grid.count()), importance)) {
      plan.counts = samples_per_cell(importance, samples - plan.grid.count(), u);
      return plan;
    }
  }
  plan.grid = HemisphereGrid::for_samples(samples);
  importance.assign(size_t(plan.grid.count()), 1.0f);
  plan.counts = samples_per_cell(importance, samples - plan.grid.count(), u);
  return plan;
}

/// 1/m; nothing comes from nearer than the smallest length that keeps gradients finite.
float inverse_distance_of(float distance) {
  return std::isnan(distance) ? 0.0f : 1.0f / std::max(distance, 1e-12f);
}

class HemisphereSampling {
 public:
  HemisphereSampling(const RadianceSource& source, const SurfacePoint& at, const Frame& frame,
                     const HemisphereGrid& grid, const Sampler& sampler, const Medium* medium,
                     Scratch& scratch)
      : source_(source),
        at_(at),
        frame_(frame),
        grid_(grid),
        sampler_(sampler),
        medium_(medium),
        scratch_(scratch) {}

  HemisphereCell sample_cell(int index, uint32_t count, HemisphereEstimate& estimate) {
    HemisphereCell cell;
    cell.direction = grid_.direction(index, Vec2f(0.5f));
    uint32_t valid = 0;
    for (uint32_t i = 0; i < count; ++i) {
      Sampler sampler = sampler_.split(Split::hemisphere_ray, next_index_++);
      const Vec3f local = grid_.direction(index, sampler.next_2d());
      const Vec3f direction = frame_.to_world(local);
      if (dot(at_.ng, direction) * dot(at_.ng, frame_.z) < 0) {
        ++valid;  // below the surface: dark
        continue;
      }
      cell.open = true;
      sampler.start_vertex(0);
      const RadianceSource::Incoming incoming =
          source_.incoming_through(medium_, at_, direction, sampler, scratch_);
      ++estimate.rays;
      if (!incoming.radiance.is_finite()) {
        ++estimate.dropped;
        continue;
      }
      ++valid;
      if (!(cell.distance < infinity)) cell.direction = local, cell.distance = incoming.distance;
      cell.radiance += incoming.radiance;
      cell.inverse_distance += inverse_distance_of(incoming.distance);
      estimate.minimum_distance = std::min(estimate.minimum_distance, incoming.distance);
    }
    if (valid > 1) {
      cell.radiance = cell.radiance / float(valid);
      cell.inverse_distance /= float(valid);
    }
    return cell;
  }

 private:
  const RadianceSource& source_;
  const SurfacePoint& at_;
  const Frame& frame_;
  const HemisphereGrid& grid_;
  const Sampler& sampler_;
  const Medium* medium_;
  Scratch& scratch_;
  uint32_t next_index_ = 0;
};

/// Tangent vectors, one per lane, summed as lanes.
struct TangentSum {
  Spectrum x, y;

  void add(const Vec2f& direction, const Spectrum& value) {
    x += value * direction.x;
    y += value * direction.y;
  }
  void to_world(const Frame& frame, Vec3f (&result)[Spectrum::lane_count]) const {
    for (int lane = 0; lane < Spectrum::lane_count; ++lane)
      result[lane] = frame.x * x[lane] + frame.y * y[lane];
  }
};

/// The sums over cells of Ward and Heckbert (1992). A cell's constant radiance is integrated
/// exactly over the cell, so azimuthal means of unit vectors carry the factor sin(Δφ/2)/(Δφ/2).
class CellSums {
 public:
  CellSums(const HemisphereGrid& grid, const std::vector<HemisphereCell>& cells)
      : grid_(grid), cells_(cells), delta_phi_(2 * pi / float(grid.phi_cells)) {
    shrink_ = std::sin(0.5f * delta_phi_) / (0.5f * delta_phi_);
    directions_.resize(size_t(grid.phi_cells) * 2);  // centres and lower borders, alternately
    for (size_t i = 0; i < directions_.size(); ++i) {
      const float phi = 0.5f * delta_phi_ * float(i);
      directions_[i] = {std::cos(phi), std::sin(phi)};
    }
  }

  Spectrum irradiance() const {
    Spectrum total;
    for (int i = 0; i < grid_.theta_cells; ++i) {
      Spectrum row;
      for (int j = 0; j < grid_.phi_cells; ++j) row += cell(i, j).radiance;
      total += row;
    }
    return total * (pi / float(grid_.count()));
  }

  float mean_inverse_distance() const {
    double total = 0;
    for (const HemisphereCell& c : cells_) total += double(c.inverse_distance);
    return float(total / double(cells_.size()));
  }

  /// Turning the normal about an axis a changes E by a · ∫ L (n × ω) dω.
  TangentSum rotation() const {
    TangentSum sum;
    for (int i = 0; i < grid_.theta_cells; ++i) {
      const float integral = sine_integral(i + 1) - sine_integral(i);  // ∫ sin²θ dθ
      for (int j = 0; j < grid_.phi_cells; ++j)
        sum.add(turned(center(j)), cell(i, j).radiance * (integral * delta_phi_ * shrink_));
    }
    return sum;
  }

  /// Moving the point shifts the border between two cells by the parallax of the nearer one.
  TangentSum translation() const {
    TangentSum sum;
    for (int i = 0; i < grid_.theta_cells; ++i) {
      const float width = sine(i + 1) - sine(i);
      for (int j = 0; j < grid_.phi_cells; ++j) {
        const int before = j > 0 ? j - 1 : grid_.phi_cells - 1;
        sum.add(turned(border(j)), border_change(cell(i, j), cell(i, before)) * width);
        if (i == 0) continue;
        const float theta_edge = sine(i) * (1 - sqr(sine(i))) * delta_phi_ * shrink_;
        sum.add(center(j), border_change(cell(i, j), cell(i - 1, j)) * theta_edge);
      }
    }
    return sum;
  }

 private:
  const HemisphereCell& cell(int i, int j) const { return cells_[size_t(i * grid_.phi_cells + j)]; }
  Vec2f center(int j) const { return directions_[size_t(2 * j + 1)]; }
  Vec2f border(int j) const { return directions_[size_t(2 * j)]; }
  static Vec2f turned(const Vec2f& v) { return {-v.y, v.x}; }
  float sine(int i) const { return std::sqrt(float(i) / float(grid_.theta_cells)); }
  float sine_integral(int i) const {
    const float s = sine(i);
    return 0.5f * (std::asin(s) - s * safe_sqrt(1 - s * s));
  }
  static Spectrum border_change(const HemisphereCell& a, const HemisphereCell& b) {
    if (!a.open || !b.open) return Spectrum();  // the horizon moves along with the point
    return (a.radiance - b.radiance) * std::max(a.inverse_distance, b.inverse_distance);
  }

  const HemisphereGrid& grid_;
  const std::vector<HemisphereCell>& cells_;
  float delta_phi_, shrink_;
  std::vector<Vec2f> directions_;
};

}  // namespace

HemisphereGrid HemisphereGrid::for_samples(int samples) {
  HemisphereGrid grid;
  grid.theta_cells = std::max(1, int(std::lround(std::sqrt(float(samples) * inv_pi))));
  grid.phi_cells = std::max(1, samples / grid.theta_cells);
  return grid;
}

int HemisphereGrid::cell_of(const Vec3f& d) const {
  const float sine_sq = d.x * d.x + d.y * d.y;
  float turn = std::atan2(d.y, d.x) * (0.5f * inv_pi);
  if (turn < 0) turn += 1;
  const int i = to_integer(sine_sq * float(theta_cells), 0, theta_cells - 1);
  const int j = to_integer(turn * float(phi_cells), 0, phi_cells - 1);
  return i * phi_cells + j;
}

Vec3f HemisphereGrid::direction(int cell, const Vec2f& st) const {
  const int i = cell / phi_cells, j = cell % phi_cells;
  const float sine_sq = std::min((float(i) + st.x) / float(theta_cells), one_minus_epsilon);
  const float phi = 2 * pi * (float(j) + st.y) / float(phi_cells);
  const float sine = std::sqrt(sine_sq);
  return {sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1 - sine_sq)};
}

HemisphereEstimate sample_hemisphere(const RadianceSource& source, const SurfacePoint& at,
                                     const Vec3f& normal, const HemisphereSettings& settings,
                                     const Sampler& sampler, const Medium* medium) {
  const Frame frame(normal);
  Sampler offset = sampler;
  Scratch scratch;  // for all rays
  const Plan plan = plan_samples(source, at, frame, settings, offset.next_1d(), scratch);

  HemisphereEstimate estimate;
  HemisphereSampling sampling(source, at, frame, plan.grid, sampler, medium, scratch);
  std::vector<HemisphereCell> cells(plan.counts.size());
  for (size_t i = 0; i < cells.size(); ++i)
    cells[i] = sampling.sample_cell(int(i), plan.counts[i], estimate);

  const CellSums sums(plan.grid, cells);
  estimate.irradiance = sums.irradiance();
  estimate.harmonic_distance = 1 / sums.mean_inverse_distance();
  sums.rotation().to_world(frame, estimate.rotation_gradient);
  sums.translation().to_world(frame, estimate.translation_gradient);
  if (settings.hessian) estimate.translation_hessian = translation_hessian(plan.grid, cells);
  return estimate;
}

}  // namespace kaustik
