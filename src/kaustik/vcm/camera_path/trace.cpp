#include <algorithm>

#include "kaustik/vcm/camera_path/camera_path.h"

namespace kaustik {
namespace {

/// Events after which paths no longer branch, and surfaces that branches go straight through.
constexpr int most_split_events = 4, most_split_straight = 8;

/// A path of several that camera paths branch into at smooth transparent surfaces.
struct Branch {
  float share = 1;     ///< what chance would have left of such paths, over what was followed
  float survival = 1;  ///< with which it is followed beyond the next vertex
  int straight = 0;    ///< surfaces at which one branch went straight on

  /// One that chance would choose that often.
  Branch by(float chance) const {
    // Followed so many times more often than chance would have it.
    constexpr float most_often = 8;
    Branch result = *this;
    result.survival = survival * std::min(1.0f, most_often * share * chance);
    result.share = share * chance * survival / result.survival;
    return result;
  }
};

void follow(CameraPath& path, Branch branch);

/// Follows the less likely of two events and lets `stem` go on by the other.
void split(CameraPath& stem, const CameraWalk::DeltaEvents& events, Branch& branch) {
  const bool mirrors = events.reflection.pdf_solid_angle > events.transmission.pdf_solid_angle;
  const BsdfSample& likely = mirrors ? events.reflection : events.transmission;
  const BsdfSample& other = mirrors ? events.transmission : events.reflection;
  // Layers of what is seen show the likely one.
  const FirstHit seen = stem.walk().first_hit();
  {
    Sampler numbers = stem.walk().sampler().fork(Fork::delta_branch);
    CameraPath path(stem, numbers);
    path.walk().branch(other);
    path.leave();
    if (path.walk().may_find_more()) follow(path, branch.by(other.pdf_solid_angle));
  }
  stem.walk().set_first_hit(seen);
  stem.walk().branch(likely);
  branch = branch.by(likely.pdf_solid_angle);
}

/// Follows the branch that goes straight on where the walk waits, and lets `stem` stay.
void split_straight(CameraPath& stem, Branch& branch) {
  CameraWalk& walk = stem.walk();
  const float chance = walk.straight_chance();
  const FirstHit seen = walk.first_hit();
  ++branch.straight;
  {
    Sampler numbers = walk.sampler().fork(Fork::straight_branch);
    CameraPath path(stem, numbers);
    path.walk().go_straight();
    follow(path, branch.by(chance));
  }
  // Layers of what is seen show the likely one.
  if (chance > 0.5f)
    walk.keep_first_hit();
  else
    walk.set_first_hit(seen);
  walk.stay_at_surface();
  branch = branch.by(1 - chance);
}

/// Takes the path to its end.
void follow(CameraPath& path, Branch branch) {
  const CameraPathInputs& in = path.inputs();
  const Techniques& techniques = in.techniques();
  CameraWalk& walk = path.walk();
  Sampler& sampler = walk.sampler();
  for (;;) {
    const auto may_split = [&] {
      return path.vertices().is_at_first() && walk.events() < most_split_events;
    };
    walk.wait_at_straight(may_split() && branch.straight < most_split_straight);
    const CameraWalk::Arrival arrival =
        path.go_on(in.scene.has_scattering(), nullptr, [&] { split_straight(path, branch); });
    if (arrival == CameraWalk::Arrival::nothing) return;
    // Lamps that a branch shows it shows always; all else as often as it is worth.
    if (branch.survival < 1) {
      if (!walk.survive_with(branch.survival, sampler.next_1d())) return;
      branch.survival = 1;
    }
    const bool in_medium = arrival == CameraWalk::Arrival::medium;
    if (walk.events() >= in.maximum_events) return;
    if (in.cache && !in_medium) path.ask_cache();
    if (techniques.next_event) path.add_direct_light();
    if (techniques.merging && !in_medium) path.merge();
    if (techniques.connections) path.connect();
    const Vec2f u = sampler.next_2d(), u_choice = sampler.next_2d();
    if (const auto events = !in_medium && may_split() ? walk.delta_events() : std::nullopt) {
      split(path, *events, branch);
    } else if (in_medium) {
      walk.scatter_in_medium(u);
    } else if (!walk.scatter(Lobes::all, 1, u_choice.x, u)) {
      return;
    }
    path.leave();
    if (!walk.may_find_more()) return;
    if (!path.survives_first(sampler.next_1d())) return;
    if (walk.events() > in.roulette_depth && !walk.survive(u_choice.y)) return;
  }
}

}  // namespace

void trace_camera_path(const CameraPathInputs& inputs, const PixelPlan& plan, const Vec2f& raster,
                       Sampler& sampler, SampleSink& sink) {
  CameraPath path(inputs, plan, raster, sampler, sink);
  follow(path, {});
}

}  // namespace kaustik
