#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/thesis/workplace.h"
#include "kaustik/render/session.h"

namespace kaustik::thesis {

/// Counts rays by kind; slows rendering, so counts are taken in runs of their own.
class RayCounter final : public RayObserver {
 public:
  void on_ray(const Ray&, bool shadow) override {
    (shadow ? shadow_rays : closest_rays).fetch_add(1, std::memory_order_relaxed);
  }
  std::atomic<uint64_t> closest_rays{0}, shadow_rays{0};
};

/// What a run changes in a scene file.
struct Changes {
  std::string integrator = "photonmap";
  std::vector<std::string> settings;  ///< "object.parameter=value"
  int width = 0, height = 0;          ///< 0: the file's
  bool box_filter = false;            ///< pixels are means over their squares
};

/// A shipped scene with an integrator, ready to be rendered.
class SceneRun {
 public:
  explicit SceneRun(const std::string& name, const Changes& changes = {},
                    RayObserver* observer = nullptr);

  struct Result {
    Image image;
    SessionReport report;
  };
  Result render(const SessionSettings& settings) const;
  const Scene& scene() const { return *scene_; }
  const Integrator& integrator() const { return *integrator_; }
  const Description& description() const { return description_; }

 private:
  Description description_;
  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<Integrator> integrator_;
};

/// `samples` per pixel in all, in so many passes.
SessionSettings in_passes(uint32_t samples, uint32_t passes, uint64_t seed, int threads);

/// The reference called `name`: read from the work folder, or made and kept there.
Image reference(const Workplace& place, const std::string& name,
                const std::function<Image()>& make);

/// Tells on the error stream what is being done.
void say(const std::string& text);

}  // namespace kaustik::thesis
