// The part of Directives that stands before the world: camera, film, method, options.

#include <fmt/format.h>

#include "kaustik/loader/pbrt/directives.h"

namespace kaustik::pbrt {

void Directives::camera(const Call& call) {
  view_.camera = setting(call);
  if (state_.transform.start.dimensions() < 3 || state_.transform.end.dimensions() < 3)
    throw Error(ErrorKind::input, "the camera's transform is singular",
                "leave out factors of 0 before Camera", call.place());
  if (state_.transform.is_moving && !(state_.transform.start == state_.transform.end))
    deviations_.approximated("camera", "it stands still, where its motion begins", call.place());
  view_.camera_from_world = state_.transform.start;
  camera_medium_ = state_.media.outside;
  MovingTransform& world_from_camera = coordinate_systems_["camera"];
  world_from_camera = state_.transform;
  world_from_camera.start = state_.transform.start.inverse();
  world_from_camera.end = state_.transform.end.inverse();
}

void Directives::film(const Call& call) {
  view_.film = setting(call);
  if (is_old_film(view_.film->type)) world_.become_old();
  if (state_.colour_space != ColourSpace::srgb)
    deviations_.approximated("film", "the picture has the primaries of Rec. 709", call.place());
}

void Directives::sampler(const Call& call) { view_.sampler = setting(call); }
void Directives::integrator(const Call& call) { view_.integrator = setting(call); }
void Directives::pixel_filter(const Call& call) { view_.filter = setting(call); }
void Directives::accelerator(const Call& call) { setting(call); }

void Directives::option(const Call& call) {
  const std::string name = quoted(call, "a name");
  const Token value = call.tokens.next();
  if (value.kind == TokenKind::end)
    throw Error(ErrorKind::input, "Option lacks a value", "write it behind the name", call.place());
  // Those that change neither light nor picture.
  for (const std::string_view harmless :
       {"seed", "renderingspace", "pixelstats", "displayserver", "wavefront", "nthreads", "quiet",
        "msereferenceimage", "msereferenceout", "debugstart"})
    if (is_same_name(name.substr(name.rfind(' ') + 1), harmless)) return;
  deviations_.ignored(fmt::format("option {}", shown(name)), "it has no effect", call.place());
}

}  // namespace kaustik::pbrt
