#include "tests/fuzz/scene_check.h"

#include <fmt/format.h>

#include <cmath>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/photon_tracing.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/scene_report.h"

namespace kaustik::fuzz {
namespace {

/// Empty if the error says what it has to: of a scene alone, so that the machine is not to blame.
std::string complaint_about(const Error& error) {
  if (error.kind() != ErrorKind::input) return fmt::format("blames the machine: {}", error.what());
  if (error.problems().empty()) return "an error without a problem";
  for (const Problem& problem : error.problems()) {
    if (problem.message.empty()) return "an error without a message";
    if (!problem.place.file) return fmt::format("an error without a place: {}", problem.message);
  }
  return "";
}

std::string complaint_about(const Image& image) {
  for (int c = 0; c < image.channel_count(); ++c)
    for (const float value : image.channel(c))
      if (!std::isfinite(value))
        return fmt::format("channel {} holds {}", image.channel_names()[size_t(c)], value);
  return "";
}

/// How `body` ended: what it says is wrong, or what is wrong with what it threw.
struct Outcome {
  std::string complaint;
  bool refused = false;
  std::string refusal;  ///< the whole text
};
Outcome outcome_of(const std::function<std::string()>& body) {
  try {
    return {body(), false, ""};
  } catch (const Error& error) {
    return {complaint_about(error), true, error.what()};
  } catch (const std::exception& error) {
    return {fmt::format("an exception that is no Error: {}", error.what()), true, ""};
  }
}

class Check {
 public:
  Check(const GeneratedScene& generated, const std::function<void(size_t)>& begins)
      : generated_(generated), begins_(begins) {}

  SceneResult run() {
    begins_(generated_.integrators.size());
    result_.refused = tell("", [&] {
      description_ = parse(generated_.with(""));
      scene_ = build_scene(description_);
      describe_scene(*scene_);
      return std::string();
    });
    if (result_.refused || !scene_) return result_;
    for (size_t i = 0; i < generated_.integrators.size(); ++i) {
      begins_(i);
      const std::string& xml = generated_.integrators[i].xml;
      result_.renders_refused += tell(xml, [&] { return render(xml); });
      if (generated_.integrators[i].type != "photonmap") continue;
      tell(xml, [&] { return trace_photons(xml); });
    }
    return result_;
  }

 private:
  static Description parse(const std::string& xml) {
    return parse_mitsuba_xml(xml, "scene.xml", "");
  }

  /// Returns whether it threw an Error.
  bool tell(const std::string& integrator_xml, const std::function<std::string()>& body) {
    const Outcome outcome = outcome_of(body);
    if (!outcome.complaint.empty())
      result_.failures.emplace_back(outcome.complaint, generated_.with(integrator_xml));
    if (!outcome.refusal.empty()) result_.refusals.push_back(outcome.refusal);
    return outcome.refused;
  }

  std::string render(const std::string& integrator_xml) {
    const Description description = parse(generated_.with(integrator_xml));
    std::vector<std::string> warnings;
    const auto integrator = make_integrator(description, *scene_, warnings);
    SessionSettings settings;
    settings.threads = 1;
    settings.passes = 2;
    settings.samples_per_pass = 1;
    Session session(*scene_, *integrator, settings);
    const uint64_t lost_before = scene_->tracer().refused_rays();
    const SessionReport report = session.run();
    ++result_.renders;
    result_.dropped += report.dropped_samples > 0;
    result_.with_lost_rays += scene_->tracer().refused_rays() > lost_before;
    if (report.passes != 2) return fmt::format("{} passes instead of two", report.passes);
    return complaint_about(session.film().image());
  }

  std::string trace_photons(const std::string& integrator_xml) {
    trace_photon_maps(parse(generated_.with(integrator_xml)), *scene_, 1, 1);
    return "";
  }

  const GeneratedScene& generated_;
  const std::function<void(size_t)>& begins_;
  SceneResult result_;
  Description description_;
  std::shared_ptr<const Scene> scene_;
};

}  // namespace

SceneResult check_scene(const GeneratedScene& scene, const std::function<void(size_t)>& begins) {
  return Check(scene, begins).run();
}

}  // namespace kaustik::fuzz
