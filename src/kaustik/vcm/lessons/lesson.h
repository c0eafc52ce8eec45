#pragma once
#include <memory>
#include <stop_token>

#include "kaustik/base/bytes.h"
#include "kaustik/vcm/lessons/training_samples.h"
#include "kaustik/vcm/light_vertices.h"
#include "kaustik/vcm/plan/plans.h"

namespace kaustik {

/// A pass whose light paths have been traced, for who learns from it.
struct TaughtPass {
  const Pass& pass;
  const LightVertices& light;
  /// A camera sample as the pass takes it, at a place of the plans' window.
  TakeSample sample;
};

/// What one pass adds to a lesson.
class LessonSums {
 public:
  virtual ~LessonSums() = default;
};

/// Something that finished passes of a seed teach. What passes add is looked up pass by pass, by
/// any number of them at a time, and added in the order of the passes; plans change at the begin of
/// epochs, by the sums of all passes before. What was added goes into a file and comes back from
/// there, so that who goes on need not trace the passes again.
class Lesson {
 public:
  virtual ~Lesson() = default;
  /// Forgets what passes have added: those to come are of another seed.
  virtual void begin() = 0;
  /// Passes from this one on teach nothing.
  virtual uint32_t end() const = 0;
  /// Whether the pass, one before the end, teaches anything.
  virtual bool wants(uint32_t pass) const = 0;
  /// Whether its camera samples are asked for: what they connect to is of use then.
  virtual bool wants_samples(uint32_t /*pass*/) const { return false; }
  /// What a pass that is wanted adds. Counts the rays. Worth nothing if it was stopped.
  virtual std::unique_ptr<LessonSums> sums_of(const TaughtPass& taught, const std::stop_token& stop,
                                              uint64_t& rays) const = 0;
  /// Of sums_of() the next wanted pass.
  virtual void add(uint32_t pass, const LessonSums& sums) = 0;
  /// Changes the plans of the epoch that begins with pass `epoch` by all passes before, which have
  /// been added. Asked once for each epoch, in their order, but for those before one that was read.
  /// Counts the rays. Worth nothing if it was stopped.
  virtual void apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop,
                     uint64_t& rays) = 0;

  /// What passes have added and epochs have decided.
  virtual void write(ByteWriter& writer) const = 0;
  /// The same back, of the same scene and settings. Throws as ByteReader does.
  virtual void read(ByteReader& reader) = 0;
};

}  // namespace kaustik
