#include "kaustik/transport/path_weights.h"

#include <algorithm>
#include <cstddef>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Both halves as one path x₁ … xₙ, and the densities of all techniques relative to that of
/// connecting the halves where they meet. With Q_i the product of the camera's densities up to x_i
/// and of the lights' beyond it, x_i is
///   connected to x_i+1 with density Q_i · connections,
///   merged with Q_i · p_light(x_i) · n A_i (in media a volume in place of the area A_i),
/// and the whole path is splatted with Q_0 · n, sampled with Q_n-1 · p_next / p_light(x_n), met
/// with Q_n. `ratio` is Q_i / Q_t.
class PathWeights::View {
 public:
  enum class Meeting { between, at_last };  ///< x_t and x_t+1, or at x_t
  View(const Settings& settings, const PathHalves& path, Meeting meeting)
      : settings_(settings),
        path_(path),
        meeting_(meeting),
        t_(path.camera.size()),
        n_(path.camera.size() + path.light.size()) {
    while (first_ < t_ && path_.camera[first_ - 1].delta) ++first_;
    if (vertex(first_).mean_free_path > 0) return;
    first_survival_ = path_.first_survival;
    first_light_samples_ = path_.first_light_samples;
  }

  size_t t() const { return t_; }
  size_t n() const { return n_; }

  float pdf_light(size_t i) const {
    if (i == t_) return path_.pdf_light_last;
    if (i + 1 == t_) return path_.pdf_light_before_last;
    return vertex(i).pdf_light;
  }
  /// Density of x_i on its own …
  float pdf_camera(size_t i) const {
    if (i == t_ + 1) return path_.pdf_camera_last;
    if (i == t_ + 2) return path_.pdf_camera_before_last;
    return vertex(i).pdf_camera;
  }
  /// … and with the chance that the path comes there.
  float reach(size_t i) const {
    return i == first_ + 1 ? pdf_camera(i) * first_survival_ : pdf_camera(i);
  }
  /// At vertices where the halves meet what is not delta counts, whatever event the light path went
  /// on by.
  bool is_delta(size_t i) const {
    const bool meets = i == t_ || (i == t_ + 1 && meeting_ == Meeting::between);
    return !meets && i >= 1 && i <= n_ && vertex(i).delta;
  }
  /// Up to x_i, i ≤ t.
  float camera_spread(size_t i) const { return i >= 1 ? path_.camera[i - 1].spread : 1.0f; }

  float connection(float ratio, size_t i) const {
    if (!settings_.techniques.connections || i < 1 || i + 2 > n_ || is_delta(i) || is_delta(i + 1))
      return 0;
    return ratio * settings_.connections;
  }
  float splat(float ratio) const {
    if (!settings_.techniques.splats || n_ < 3 || is_delta(1)) return 0;
    return ratio * settings_.light_paths;
  }
  float next_event(float ratio) const {
    if (!settings_.techniques.next_event || n_ < 2 || is_delta(n_ - 1)) return 0;
    const float samples = n_ == first_ + 1 ? first_light_samples_ : 1.0f;
    return ratio * samples * path_.pdf_next_event / pdf_light(n_);
  }
  /// Whether paths end is asked at the vertex behind the first: lamps are met there for sure.
  float unidirectional(float ratio) const {
    if (!settings_.techniques.unidirectional) return 0;
    return n_ == first_ + 1 ? ratio / first_survival_ : ratio;
  }
  /// The spread is that up to x_i.
  float merge(float ratio, size_t i, float camera_spread) const {
    if (!settings_.techniques.merging || i < 1 || i + 1 > n_ || is_delta(i)) return 0;
    const PathVertex& at = vertex(i);
    const bool in_medium = at.mean_free_path > 0;
    if (!in_medium && i + 2 > n_) return 0;
    const float density = ratio * pdf_light(i) * settings_.light_paths;
    if (i == first_)
      return density *
             (in_medium ? at.merge_volume * settings_.first_medium_share : path_.first_merge_area);
    if (camera_spread < settings_.least_spread) return 0;
    return density * (in_medium ? at.merge_volume : settings_.merge_area);
  }
  /// 1 ≤ i ≤ n.
  const PathVertex& vertex(size_t i) const {
    return i <= t_ ? path_.camera[i - 1] : path_.light[n_ - i];
  }

 private:
  const Settings& settings_;
  const PathHalves& path_;
  Meeting meeting_;
  size_t t_, n_;
  size_t first_ = 1;  ///< the first vertex whose event is not delta
  float first_survival_ = 1, first_light_samples_ = 1;
};

float PathWeights::squares_at(const View& path, size_t i, float scale, float camera_spread) const {
  const size_t n = path.n();
  if (i == 0) return sqr(path.splat(scale));
  float sum = sqr(path.connection(scale, i)) + sqr(path.merge(scale, i, camera_spread));
  if (i + 1 == n) sum += sqr(path.next_event(scale));
  if (i == n) sum += sqr(path.unidirectional(scale));
  return sum;
}

float PathWeights::squares_beyond(const View& path, float scale) const {
  const size_t t = path.t(), n = path.n();
  float sum = 0, ratio = scale, camera_spread = path.camera_spread(t);
  for (size_t i = t + 1; i <= n; ++i) {
    ratio *= path.reach(i) / path.pdf_light(i);
    if (!(ratio > 0)) break;
    if (i >= 2)
      camera_spread =
          spread_after(camera_spread, path.pdf_camera(i), path.vertex(i), path.is_delta(i - 1));
    sum += squares_at(path, i, ratio, camera_spread);
  }
  return sum;
}

float PathWeights::squares_before(const View& path, float scale) const {
  float sum = 0, ratio = scale;
  for (size_t i = path.t(); i-- > 0;) {
    ratio *= path.pdf_light(i + 1) / path.reach(i + 1);
    if (!(ratio > 0)) break;
    sum += squares_at(path, i, ratio, path.camera_spread(i));
  }
  return sum;
}

float PathWeights::weight(const View& path, float own_density) const {
  if (!(own_density > 0)) return 0;
  // Relative to one's own, so that squares stay within bounds.
  const float scale = 1 / own_density;
  const size_t t = path.t();
  const float sum = squares_at(path, t, scale, path.camera_spread(t)) +
                    squares_beyond(path, scale) + squares_before(path, scale);
  return sum > 0 ? 1 / sum : 0.0f;
}

PathWeights::MattMerge PathWeights::matt_merge(const PathHalves& path) const {
  const View view(settings_, path, View::Meeting::at_last);
  const float density = view.pdf_light(view.t()) * settings_.light_paths * unit_area();
  if (!(density > 0)) return {1e30f, 1e30f};
  return {.connection = sqr(view.connection(1 / density, view.t())),
          .beyond = squares_beyond(view, 1 / density)};
}

PathWeights::MattVertex PathWeights::matt_vertex(std::span<const PathVertex> camera,
                                                 float merge_area, float survival) const {
  MattVertex result;
  // Splats find what the camera sees directly, by a density that is that of merging but for this:
  if (settings_.techniques.splats && camera.size() == 1)
    result.base += sqr(1 / (camera[0].pdf_camera * merge_area));
  constexpr float most = 1e30f;  // infinite factors of what is zero would make no sense
  const float units = unit_area() / merge_area;
  result.on_beyond = std::min(most, sqr(survival * units));
  if (settings_.techniques.connections) result.on_connection = std::min(most, sqr(units));
  return result;
}

bool PathWeights::merges_at(std::span<const PathVertex> camera) const {
  if (!settings_.techniques.merging) return false;
  size_t first = 1;
  while (first < camera.size() && camera[first - 1].delta) ++first;
  return first == camera.size() || camera.back().spread >= settings_.least_spread;
}

PathWeights::LightTail PathWeights::light_tail(const PathHalves& path,
                                               std::vector<LaterMerge>& merges) const {
  const View view(settings_, path, View::Meeting::at_last);
  const size_t t = view.t(), n = view.n();
  LightTail tail{.pdf_light = view.pdf_light(t),
                 .to_previous = path.pdf_camera_last,
                 .spread_length = 1,
                 .merges = uint32_t(merges.size())};
  const float density = tail.pdf_light * settings_.light_paths * unit_area();
  if (!(density > 0)) return tail;
  if (const float length = view.vertex(t + 1).mean_free_path; length > 0)
    tail.spread_length = length;
  tail.connection = sqr(view.connection(1 / density, t));
  float ratio = 1 / density, spread = 1;
  for (size_t i = t + 1; i <= n; ++i) {
    ratio *= view.pdf_camera(i) / view.pdf_light(i);
    if (!(ratio > 0)) break;
    if (i > t + 1)
      spread = spread_after(spread, view.pdf_camera(i), view.vertex(i), view.is_delta(i - 1));
    const float merge = view.merge(ratio, i, std::max(spread, settings_.least_spread));
    tail.square += squares_at(view, i, ratio, -1);
    if (merge > 0) merges.push_back({sqr(merge), spread});
  }
  tail.count = uint32_t(merges.size()) - tail.merges;
  return tail;
}

float PathWeights::merge(const PathHalves& path, const LightTail& tail,
                         std::span<const LaterMerge> merges) const {
  const View view(settings_, path, View::Meeting::at_last);
  const size_t t = view.t();
  const float spread = view.camera_spread(t), own_density = view.merge(1, t, spread);
  if (!(own_density > 0)) return 0;
  const float scale = 1 / own_density;
  float beyond = tail.square;
  float spread_beyond = spread * accepted(path.pdf_camera_last * tail.spread_length);
  for (const LaterMerge& merge : merges) {
    if (spread_beyond * merge.spread < settings_.least_spread) break;
    beyond += merge.square;
  }
  // From merging on unit_area() to here, and reach() of the first vertex beyond, per solid angle.
  const float units = scale * tail.pdf_light * settings_.light_paths * unit_area();
  const float on_beyond =
      tail.to_previous > 0 ? view.reach(t + 1) / tail.to_previous * units : 0.0f;
  const float sum =
      1 + tail.connection * sqr(units) + beyond * sqr(on_beyond) + squares_before(view, scale);
  return sum > 0 ? 1 / sum : 0.0f;
}

float PathWeights::unidirectional(const PathHalves& path) const {
  const View view(settings_, path, View::Meeting::between);
  return weight(view, view.unidirectional(1));
}

float PathWeights::next_event(const PathHalves& path) const {
  const View view(settings_, path, View::Meeting::between);
  return weight(view, view.next_event(1));
}

float PathWeights::splat(const PathHalves& path) const {
  const View view(settings_, path, View::Meeting::between);
  return weight(view, view.splat(1));
}

float PathWeights::connection(const PathHalves& path) const {
  const View view(settings_, path, View::Meeting::between);
  return weight(view, view.connection(1, view.t()));
}

float PathWeights::beyond_merge(const PathHalves& path) const {
  const View view(settings_, path, View::Meeting::at_last);
  const size_t t = view.t();
  const float density = view.merge(1, t, view.camera_spread(t));
  return density > 0 ? squares_beyond(view, 1 / density) : 0.0f;
}

float PathWeights::merge(const PathHalves& path) const {
  const View view(settings_, path, View::Meeting::at_last);
  const size_t t = view.t();
  return weight(view, view.merge(1, t, view.camera_spread(t)));
}

}  // namespace kaustik
