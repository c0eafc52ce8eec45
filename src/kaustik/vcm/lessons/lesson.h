#pragma once
#include <algorithm>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "kaustik/base/bytes.h"
#include "kaustik/vcm/lessons/training_samples.h"
#include "kaustik/vcm/light_vertices.h"
#include "kaustik/vcm/plan/plans.h"

namespace kaustik {

/// What a lesson asks of a pass that is to teach it.
struct LessonNeeds {
  bool light = false;             ///< its light paths
  bool pairs = false;             ///< training pairs, which take its light paths, too
  uint32_t remembered_paths = 0;  ///< how so many of its light paths began: LightVertices

  bool any() const { return light || pairs || remembered_paths > 0; }
  /// What both ask for.
  LessonNeeds with(const LessonNeeds& other) const {
    return {.light = light || other.light,
            .pairs = pairs || other.pairs,
            .remembered_paths = std::max(remembered_paths, other.remembered_paths)};
  }
};

/// A pass whose light paths have been traced, for who learns from it.
struct TaughtPass {
  /// By sets of wavelengths, one at least.
  std::vector<const LightVertices*> light;
  /// Lesson::places(), and the pairs that were traced there.
  std::span<const TrainingPlace> places = {};
  std::span<const TrainingPair> pairs = {};
};

/// What one pass adds to a lesson.
class LessonSums {
 public:
  virtual ~LessonSums() = default;
  /// For Lesson::read_sums().
  virtual void write(ByteWriter& writer) const = 0;
};

/// Something that finished passes of a seed teach. What passes add is looked up pass by pass, by
/// any number of them at a time and anywhere, and added in the order of the passes; plans change at
/// the begin of epochs, by the sums of all passes before. What was added goes into a file and comes
/// back from there, so that who goes on need not trace the passes again.
class Lesson {
 public:
  virtual ~Lesson() = default;
  /// Forgets what passes have added: those to come are of another seed.
  virtual void begin() = 0;
  /// Passes from this one on teach nothing.
  virtual uint32_t end() const = 0;
  /// What it asks of the pass, one before the end. Nothing: the pass does not teach it.
  virtual LessonNeeds needs_of(uint32_t pass) const = 0;
  /// Where it asks for training pairs.
  virtual std::vector<TrainingPlace> places(const Pass& /*pass*/) const { return {}; }
  /// What a pass that it needs adds. Worth nothing if it was stopped.
  virtual std::unique_ptr<LessonSums> sums_of(const TaughtPass& taught,
                                              const std::stop_token& stop) const = 0;
  /// What LessonSums::write() wrote, of the same scene and settings. Throws as ByteReader does.
  virtual std::unique_ptr<LessonSums> read_sums(ByteReader& reader) const = 0;
  /// Of sums_of() the next pass that it needs.
  virtual void add(uint32_t pass, const LessonSums& sums) = 0;
  /// Changes the plans of the epoch that begins with pass `epoch` by all passes before, which have
  /// been added. Asked once for each epoch, in their order, but for those before one that was read.
  /// Counts the rays. Worth nothing if it was stopped.
  virtual void apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop,
                     uint64_t& rays) = 0;
  /// What it has decided in the plans of that epoch, for the user. Empty: nothing.
  virtual std::string decision(const VcmPlans& plans, uint32_t epoch) const = 0;

  /// What passes have added and epochs have decided.
  virtual void write(ByteWriter& writer) const = 0;
  /// The same back, of the same scene and settings. Throws as ByteReader does.
  virtual void read(ByteReader& reader) = 0;
};

}  // namespace kaustik
