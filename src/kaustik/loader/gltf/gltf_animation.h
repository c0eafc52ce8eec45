#pragma once
// Animations, as they stand at one time.

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "kaustik/loader/gltf/gltf_accessor.h"
#include "kaustik/loader/gltf/gltf_options.h"

namespace kaustik::gltf {

/// What an animation changes of a node, each an array of the node's own.
enum class Animated { translation, rotation, scale, weights };

/// Where an animation has taken nodes to.
class Pose {
 public:
  /// Null: the node has its own.
  const std::vector<double>* find(size_t node, Animated what) const {
    const auto found = values_.find({node, what});
    return found == values_.end() ? nullptr : &found->second;
  }
  void set(size_t node, Animated what, std::vector<double> values) {
    values_[{node, what}] = std::move(values);
  }

 private:
  std::map<std::pair<size_t, Animated>, std::vector<double>> values_;
};

/// The pose at the time that is asked for, of the animation that is asked for, or the first one.
/// Empty where no time is asked for: that, and all that is left out, is told. Throws Error(input)
/// for channels that are wrong, and where there is no such animation.
Pose pose_of(File& file, Accessors& accessors, const Options& options, Deviations& deviations);

}  // namespace kaustik::gltf
