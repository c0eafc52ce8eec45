#pragma once
#include <string>
#include <vector>

#include "kaustik/photon/emission/emission.h"
#include "kaustik/transport/component.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/transport/path_weights.h"
#include "kaustik/vcm/plan/plan_choices.h"

namespace kaustik {

/// All parameters of the integrators that combine paths from the camera with paths from the lights.
struct VcmSettings {
  ComponentSet components = ComponentSet::all();
  Techniques techniques;
  int maximum_events = any_number_of_events;
  int roulette_depth = 5;
  Aim aim = default_aim;
  bool guiding = true;
  bool guided_scattering = true;  ///< beside emission
  float light_paths = 0.25f;      ///< per camera sample
  float least_light_paths = 0;    ///< of a pass, where camera samples ask for fewer
  int connections = 1;            ///< per vertex of the camera's path
  int merge_neighbors = 30;       ///< light vertices that the first radius is made for
  float radius = 0;         ///< of merging in pass 0, m; 0: from the pixels and the light paths
  bool learn_radii = true;  ///< from a pilot and the passes before; else the first pass's shrink
  bool edges = true;        ///< disks of merging end at the straight edges around them
  bool visibility = true;   ///< what is hidden does not merge
  PlanChoices choices;      ///< what a pilot chooses, place by place, where light paths merge
  uint32_t samples_per_pass = 4;
  bool adaptive = true;              ///< camera samples go where passes before find them to differ
  bool chooses_light_paths = false;  ///< how many, or none at all, by what a pilot tells

  /// Whether light paths learn where to begin, and where to go on.
  bool guides_light_paths() const {
    return guiding && (techniques.merging || techniques.connections);
  }

  /// Whether passes learn how wide their disks may be.
  bool learns_radii() const { return learn_radii && techniques.merging && !(radius > 0); }

  // For the user: what the scene has changed of that, and what of it was asked for otherwise.
  std::vector<std::string> decisions, warnings;

  /// Of one of the tables below.
  explicit VcmSettings(const Arguments& arguments);
};

/// The same with what can't be had in the scene switched off, and what it needs switched on.
VcmSettings settings_for(const Scene& scene, const Arguments& arguments);

/// "vcm": all techniques, each of which can be switched off.
const TypeInfo& vcm_info();
/// "bdpt": all but merging.
const TypeInfo& bdpt_info();
/// "ppm": merging alone, for what light paths bring; direct light as ever.
const TypeInfo& ppm_info();

/// "auto": as ppm, and all else by what a pilot tells.
const TypeInfo& auto_info();

}  // namespace kaustik
