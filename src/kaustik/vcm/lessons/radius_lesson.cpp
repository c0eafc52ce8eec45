#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "kaustik/photon/photon_map.h"
#include "kaustik/vcm/lessons/lesson_kinds.h"
#include "kaustik/vcm/lessons/radius_learning.h"

namespace kaustik {
namespace {

struct RadiusSums final : LessonSums {
  explicit RadiusSums(std::vector<RadiusLearning::Sums> sums) : of_probes(std::move(sums)) {}
  void write(ByteWriter& writer) const override { writer.put_array(of_probes); }

  std::vector<RadiusLearning::Sums> of_probes;
};

/// Of disks around the probes, in widths of a pixel there: geometric mean. 0: there are none.
double mean_radius(const PixelPlans& pixels, float shrinkage) {
  double log_sum = 0, count = 0;
  for (size_t i = 0; i < pixels.plans().size(); ++i) {
    const PixelProbe& probe = pixels.seen().probes()[i];
    const double area = double(pixels.plans()[i].merge_area * shrinkage);
    if (!probe.found || !(probe.pixel_width > 0) || !(area > 0)) continue;
    log_sum += std::log(std::sqrt(area * double(inv_pi)) / double(probe.pixel_width));
    ++count;
  }
  return count > 0 ? std::exp(log_sum / count) : 0.0;
}

class RadiusLesson final : public Lesson {
 public:
  explicit RadiusLesson(const LessonInputs& in)
      : scene_(in.scene),
        first_(in.first),
        wanted_(in.settings.components),
        radii_(in.radii),
        sums_(first_.pixels.seen().probes().size()) {}

  void begin() override { sums_.assign(sums_.size(), {}); }
  uint32_t end() const override { return 256; }
  LessonNeeds needs_of(uint32_t) const override { return {.light = true}; }
  std::unique_ptr<LessonSums> sums_of(const TaughtPass& taught,
                                      const std::stop_token& stop) const override {
    std::vector<RadiusLearning::Sums> all(sums_.size());
    for (const LightVertices* light : taught.light) {
      const auto of_set = RadiusLearning::sums_of(first_.pixels, *light, wanted_, sums_, stop);
      for (size_t i = 0; i < all.size(); ++i) all[i].add(of_set[i]);
    }
    return std::make_unique<RadiusSums>(std::move(all));
  }
  std::unique_ptr<LessonSums> read_sums(ByteReader& reader) const override {
    return std::make_unique<RadiusSums>(sums_from(reader));
  }
  void add(uint32_t, const LessonSums& sums) override {
    const auto& added = static_cast<const RadiusSums&>(sums).of_probes;
    for (size_t i = 0; i < added.size(); ++i) sums_[i].add(added[i]);
  }
  void apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop, uint64_t& rays) override;
  std::string decision(const VcmPlans& plans, uint32_t epoch) const override;
  void write(ByteWriter& writer) const override { writer.put_array(sums_); }
  void read(ByteReader& reader) override { sums_ = sums_from(reader); }

 private:
  std::vector<RadiusLearning::Sums> sums_from(ByteReader& reader) const;

  const Scene& scene_;
  const VcmPlans& first_;
  ComponentSet wanted_;
  /// Null: made when it is first asked for, which traces rays.
  std::shared_ptr<const RadiusLearning> radii_;
  std::vector<RadiusLearning::Sums> sums_;
};

void RadiusLesson::apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop,
                         uint64_t& rays) {
  if (!radii_) {
    auto made = std::make_shared<const RadiusLearning>(scene_, first_.pixels, rays, stop);
    if (stop.stop_requested()) return;
    radii_ = std::move(made);
  }
  const float shrinkage = sqr(pass_radius(1, epoch));
  // First, so that plans are the same if they are asked for once more.
  RadiusLearning::narrow(sums_, epoch);
  plans.settle(radii_->plans(first_.pixels, sums_, epoch, shrinkage), shrinkage);
}

std::string RadiusLesson::decision(const VcmPlans& plans, uint32_t epoch) const {
  const double mean = mean_radius(plans.pixels, sqr(pass_radius(1, epoch)));
  if (!(mean > 0)) return {};
  return fmt::format(
      "disks of merging have a radius of {:.2g} pixels on average, by the passes "
      "before; they began with {:.2g}",
      mean, mean_radius(first_.pixels, 1));
}

std::vector<RadiusLearning::Sums> RadiusLesson::sums_from(ByteReader& reader) const {
  auto result = reader.get_array<RadiusLearning::Sums>(sums_.size());
  for (const RadiusLearning::Sums& sums : result)
    if (sums.levels < 1 || sums.levels > size_t(RadiusLearning::level_count))
      reader.damaged("a probe in it has another number of disks");
  return result;
}

}  // namespace

std::unique_ptr<Lesson> make_radius_lesson(const LessonInputs& in) {
  if (!in.settings.learns_radii() || !in.first.techniques.merging) return nullptr;
  return std::make_unique<RadiusLesson>(in);
}

}  // namespace kaustik
