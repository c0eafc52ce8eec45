#include "kaustik/view/view_report.h"

#include <cmath>

#include "kaustik/base/version.h"
#include "kaustik/scene/scene.h"
#include "kaustik/transport/component.h"
#include "kaustik/view/region_request.h"

namespace kaustik::view {
namespace {

constexpr size_t most_points = 400;

const char* name_of_state(EngineState state) {
  switch (state) {
    case EngineState::idle:
      return "idle";
    case EngineState::building:
      return "building";
    case EngineState::rendering:
      return "rendering";
    case EngineState::paused:
      return "paused";
    case EngineState::finished:
      return "finished";
    case EngineState::failed:
      break;
  }
  return "failed";
}

std::string text_of_exception(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "something unknown went wrong";
  }
}

}  // namespace

Json state_report(const Watched& shown, const EngineStatus& status, const PageFacts& facts) {
  const auto scene = shown.scene();
  const auto snapshot = shown.snapshot();
  const Progress& progress = status.progress;
  const bool has_error = progress.passes_done > 0 && std::isfinite(progress.relative_error);
  Json refusal = nullptr;
  if (status.refusal)
    refusal = {{"revision", status.refused_revision}, {"text", text_of_exception(status.refusal)}};
  const Vec2i size = scene      ? scene->film().crop_size
                     : snapshot ? Vec2i(snapshot->picture.width(), snapshot->picture.height())
                                : Vec2i(0, 0);
  const bool is_irradiance = scene && scene->quantity() == Quantity::irradiance;
  return {{"program", KAUSTIK_VERSION},
          {"scene", facts.scene},
          {"revision", status.revision},
          {"state", name_of_state(status.state)},
          {"failure", status.failure ? Json(text_of_exception(status.failure)) : Json(nullptr)},
          {"refusal", refusal},
          {"width", size.x},
          {"height", size.y},
          {"passes", progress.passes_done},
          {"samples", progress.samples_per_pixel},
          {"elapsed_s", progress.elapsed_s},
          {"error", has_error ? Json(progress.relative_error) : Json(nullptr)},
          {"is_moving", snapshot && snapshot->is_moving},
          {"regions", json_of(status.regions)},
          {"integrator", facts.integrator},
          {"layers", facts.layers},
          {"unit", is_irradiance ? "W/m²" : "W/(sr·m²)"},
          {"camera", json_of(facts.camera)},
          {"can_edit", facts.can_edit}};
}

std::vector<std::string> layer_names(const FilmLayers& layers) {
  std::vector<std::string> names = {""};
  if (!layers.in_images) return names;
  for (size_t c = 0; c < component_count; ++c)
    if (layers.components.has(Component(c))) names.emplace_back(component_names[c]);
  for (const char* name : {"error", "albedo", "N", "depth"}) names.emplace_back(name);
  if (layers.bias) names.emplace_back("bias");
  return names;
}

bool ErrorHistory::note(const EngineStatus& status, bool is_moving) {
  bool is_new = false;
  const Progress& progress = status.progress;
  if (status.revision != revision_ || progress.passes_done < passes_) {
    is_new = !errors_.empty();
    revision_ = status.revision;
    passes_ = seen_ = 0;
    stride_ = 1;
    elapsed_s_.clear();
    errors_.clear();
  }
  if (progress.passes_done == passes_) return is_new;
  passes_ = progress.passes_done;
  if (is_moving || !std::isfinite(progress.relative_error)) return is_new;
  if (seen_++ % stride_ != 0) return is_new;
  elapsed_s_.push_back(progress.elapsed_s);
  errors_.push_back(progress.relative_error);
  if (errors_.size() < most_points) return true;
  // Every second is left, and will be.
  for (size_t i = 0; 2 * i < errors_.size(); ++i) {
    elapsed_s_[i] = elapsed_s_[2 * i];
    errors_[i] = errors_[2 * i];
  }
  elapsed_s_.resize((errors_.size() + 1) / 2);
  errors_.resize(elapsed_s_.size());
  stride_ *= 2;
  return true;
}

Json ErrorHistory::json() const { return {{"elapsed_s", elapsed_s_}, {"error", errors_}}; }

}  // namespace kaustik::view
