#pragma once
#include "kaustik/base/bytes.h"
#include "kaustik/vcm/plan/plans.h"

namespace kaustik {

/// Plans as bytes: all but what the scene and the settings tell again.
void write_plans(ByteWriter& writer, const VcmPlans& plans);

/// Reads plans of one picture, which share what it shows.
class PlansReader {
 public:
  /// All must outlive this.
  PlansReader(ByteReader& reader, const Scene& scene, const VcmSettings& settings,
              const LightPathEmission& plain)
      : reader_(reader), scene_(scene), settings_(settings), plain_(plain) {}
  /// Throws as ByteReader does.
  VcmPlans next();

 private:
  ByteReader& reader_;
  const Scene& scene_;
  const VcmSettings& settings_;
  const LightPathEmission& plain_;
  std::shared_ptr<const SeenSurfaces> seen_;
};

}  // namespace kaustik
