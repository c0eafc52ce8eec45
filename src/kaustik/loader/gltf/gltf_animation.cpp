#include "kaustik/loader/gltf/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "kaustik/base/error.h"

namespace kaustik::gltf {
namespace {

/// The values of one channel, and its times, which grow.
struct Track {
  std::shared_ptr<const Array> times, values;
  size_t components = 0;  ///< numbers of one value
  bool is_cubic = false, is_stepped = false, is_rotation = false;

  size_t keys() const { return times->count(); }
  float time(size_t key) const { return floats_in(*times)[key]; }
  /// `part` 0, 1, 2: of cubic splines the tangent before, the value, the tangent after.
  std::span<const float> at(size_t key, size_t part = 1) const {
    const size_t item = is_cubic ? 3 * key + part : key;
    return floats_in(*values).subspan(item * components, components);
  }
};

std::vector<double> normalised(std::vector<double> q) {
  double sum = 0;
  for (const double part : q) sum += part * part;
  if (sum > 0)
    for (double& part : q) part /= std::sqrt(sum);
  return q;
}

/// Along the shorter arc of two quaternions.
std::vector<double> between_rotations(std::span<const float> from, std::span<const float> to,
                                      double share) {
  double cosine = 0;
  for (size_t i = 0; i < 4; ++i) cosine += double(from[i]) * double(to[i]);
  const double sign = cosine < 0 ? -1 : 1;
  const double angle = std::acos(std::min(1.0, std::fabs(cosine))), sine = std::sin(angle);
  // Rotations that are alike have no arc.
  const bool is_straight = sine < 1e-6;
  const double a = is_straight ? 1 - share : std::sin((1 - share) * angle) / sine;
  const double b = sign * (is_straight ? share : std::sin(share * angle) / sine);
  std::vector<double> result;
  for (size_t i = 0; i < 4; ++i) result.push_back(a * double(from[i]) + b * double(to[i]));
  return normalised(std::move(result));
}

/// Hermite's spline; tangents are per second.
std::vector<double> on_spline(const Track& track, size_t key, double share, double seconds) {
  const double t = share, tt = t * t, ttt = tt * t;
  const auto p0 = track.at(key), m0 = track.at(key, 2), p1 = track.at(key + 1),
             m1 = track.at(key + 1, 0);
  std::vector<double> result;
  for (size_t i = 0; i < track.components; ++i)
    result.push_back((2 * ttt - 3 * tt + 1) * double(p0[i]) +
                     seconds * (ttt - 2 * tt + t) * double(m0[i]) +
                     (-2 * ttt + 3 * tt) * double(p1[i]) + seconds * (ttt - tt) * double(m1[i]));
  return track.is_rotation ? normalised(std::move(result)) : result;
}

/// Before the first key and after the last one it stands still.
std::vector<double> value_at(const Track& track, double time) {
  const std::span<const float> times = floats_in(*track.times);
  const auto next =
      size_t(std::upper_bound(times.begin(), times.end(), float(time)) - times.begin());
  if (next == 0 || next == track.keys() || track.is_stepped) {
    const auto values = track.at(next == 0 ? 0 : next - 1);
    return {values.begin(), values.end()};
  }
  const double begin = double(track.time(next - 1));
  const double seconds = double(track.time(next)) - begin;
  const double share = (time - begin) / seconds;
  if (track.is_cubic) return on_spline(track, next - 1, share, seconds);
  const auto from = track.at(next - 1), to = track.at(next);
  if (track.is_rotation) return between_rotations(from, to, share);
  std::vector<double> result;
  for (size_t i = 0; i < track.components; ++i)
    result.push_back(std::lerp(double(from[i]), double(to[i]), share));
  return result;
}

std::optional<Animated> animated_of(std::string_view path) {
  if (path == "translation") return Animated::translation;
  if (path == "rotation") return Animated::rotation;
  if (path == "scale") return Animated::scale;
  if (path == "weights") return Animated::weights;
  return std::nullopt;
}

class PoseReader {
 public:
  PoseReader(File& file, Accessors& accessors, Deviations& deviations, const JsonValue& animation,
             std::string name)
      : file_(file),
        accessors_(accessors),
        deviations_(deviations),
        animation_(animation),
        name_(std::move(name)) {}

  Pose at(double time) {
    const JsonValue* channels = animation_.find("channels");
    if (!channels) return std::move(pose_);
    for (const JsonValue& channel : channels->items()) try {
        read(channel, time);
      } catch (const MissingData& missing) {
        deviations_.missing(name_, missing.what + ": what it moves stays", file_.place(channel));
      }
    return std::move(pose_);
  }

 private:
  void read(const JsonValue& channel, double time) {
    const JsonValue* target = channel.find("target");
    const auto node = target ? file_.count(*target, "node") : std::nullopt;
    const auto what = target ? animated_of(file_.text(*target, "path", "")) : std::nullopt;
    if (!node || !what) {
      deviations_.ignored(name_, "it changes more than nodes: that is left out",
                          file_.place(channel));
      return;
    }
    file_.item("nodes", *node, *target);
    const Track track = track_of(channel, *what);
    if (track.keys() > 0) pose_.set(*node, *what, value_at(track, time));
  }

  Track track_of(const JsonValue& channel, Animated what) {
    const JsonValue* samplers = animation_.find("samplers");
    const auto index = file_.count(channel, "sampler");
    if (!samplers || !index || *index >= samplers->items().size())
      file_.fail(channel, "the channel has no sampler", "export the file again");
    const JsonValue& sampler = samplers->items()[*index];
    const auto input = file_.count(sampler, "input"), output = file_.count(sampler, "output");
    if (!input || !output)
      file_.fail(sampler, "the sampler has no input or output", "export the file again");
    Track track;
    const std::string kind = file_.text(sampler, "interpolation", "LINEAR");
    track.is_cubic = kind == "CUBICSPLINE";
    track.is_stepped = kind == "STEP";
    track.is_rotation = what == Animated::rotation;
    track.times = accessors_.floats(*input, sampler);
    track.values = accessors_.floats(*output, sampler);
    const size_t items = track.keys() * (track.is_cubic ? 3 : 1);
    if (items > 0) track.components = track.values->count() / items;
    const size_t wanted = what == Animated::weights    ? track.components
                          : what == Animated::rotation ? 4
                                                       : 3;
    if (track.components != wanted || track.components * items != track.values->count())
      file_.fail(sampler, "the sampler's input does not go with its output",
                 "export the file again");
    return track;
  }

  File& file_;
  Accessors& accessors_;
  Deviations& deviations_;
  const JsonValue& animation_;
  std::string name_;
  Pose pose_;
};

/// The index of the animation of that name; of the first one where it is "".
size_t animation_of(const File& file, const std::string& name) {
  const JsonValue::Items& animations = file.list("animations");
  std::vector<std::string> names;
  for (const JsonValue& animation : animations) names.push_back(file.text(animation, "name", ""));
  if (name.empty()) return 0;
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return i;
  file.fail(file.root(), fmt::format("there is no animation '{}'", name), suggest(name, names));
}

}  // namespace

Pose pose_of(File& file, Accessors& accessors, const Options& options, Deviations& deviations) {
  const JsonValue::Items& animations = file.list("animations");
  if (!options.time && options.animation.empty()) {
    for (size_t i = 0; i < animations.size(); ++i)
      deviations.ignored(file.name_of("animation", animations[i], i),
                         "nodes stand as the file has them; gltf.time shows them at a time",
                         file.place(animations[i]));
    return {};
  }
  if (animations.empty())
    throw Error(ErrorKind::input, "the file has no animations", "leave out gltf.time",
                file.place());
  const size_t index = animation_of(file, options.animation);
  const JsonValue& animation = animations[index];
  return PoseReader(file, accessors, deviations, animation,
                    file.name_of("animation", animation, index))
      .at(options.time.value_or(0));
}

}  // namespace kaustik::gltf
