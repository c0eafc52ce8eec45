#pragma once
#include "kaustik/material/bsdf.h"
#include "kaustik/transport/component.h"

namespace kaustik {

/// Most scattering events of a path where no number of them is asked for.
inline constexpr int any_number_of_events = 1 << 20;

/// Tells the owner of a path that is followed from the camera. `traced` are the lobes whose events
/// count as G (specular): Lobes::specular for the referees.
class CameraPathClass {
 public:
  explicit CameraPathClass(Lobes traced = Lobes::specular) : traced_(traced) {}

  /// The event at the next vertex (one of diffuse, glossy, delta).
  void add_event(Lobes event) {
    const bool specular = any(event & traced_);
    if (events_ == 0) {
      first_specular_ = specular;
      first_delta_ = event == Lobes::delta;
    } else if (!specular) {
      rest_specular_ = false;
    }
    ++events_;
  }
  bool has_events() const { return events_ > 0; }
  bool all_specular() const { return events_ == 0 || (first_specular_ && rest_specular_); }
  /// Scattering in a medium.
  void add_medium_event() {
    if (events_ == 0) first_in_medium_ = true;
    rest_specular_ = false;
    ++events_;
  }
  /// Of light that is met after the events so far.
  Component component() const {
    if (events_ == 0) return Component::emission;
    if (first_in_medium_) return Component::volume;
    if (events_ == 1) return first_delta_ ? Component::specular : Component::direct;
    if (first_specular_) return Component::specular;
    return rest_specular_ ? Component::caustic : Component::indirect;
  }
  /// Whether light that is met now or after more events may be one of `wanted`.
  bool may_find(ComponentSet wanted) const {
    if (events_ == 0) return !wanted.empty();
    if (wanted.has(component())) return true;
    if (first_in_medium_) return false;
    if (first_specular_) return wanted.has(Component::specular);
    return wanted.has(Component::indirect) || (rest_specular_ && wanted.has(Component::caustic));
  }
  /// Of light that arrives at the current vertex and leaves it by `event`.
  Component component_after(Lobes event) const {
    CameraPathClass next = *this;
    next.add_event(event);
    return next.component();
  }
  /// Of light that is scattered in a medium before the next vertex.
  Component component_in_medium() const {
    CameraPathClass next = *this;
    next.add_medium_event();
    return next.component();
  }

 private:
  Lobes traced_;
  int events_ = 0;
  bool first_in_medium_ = false;
  bool first_specular_ = false, first_delta_ = false, rest_specular_ = true;
};

/// The same for a path that is followed from a light.
class LightPathClass {
 public:
  explicit LightPathClass(Lobes traced = Lobes::specular) : traced_(traced) {}

  void add_event(Lobes event) {
    ++events_;
    if (!any(event & traced_)) ++diffuse_events_;
  }
  /// Scattering in a medium.
  void add_medium_event() { ++events_, ++diffuse_events_; }
  int events() const { return events_; }
  /// Those in media included.
  int diffuse_events() const { return diffuse_events_; }
  /// The component when the vertex it has come to is seen by the camera through `event`.
  Component component_seen_by(Lobes event) const {
    if (events_ == 0) return Component::direct;
    if (any(event & traced_)) return Component::specular;
    return diffuse_events_ == 0 ? Component::caustic : Component::indirect;
  }

 private:
  Lobes traced_;
  int events_ = 0, diffuse_events_ = 0;
};

}  // namespace kaustik
