#include "kaustik/view/routes.h"

#include <fmt/format.h>

#include <utility>

#include "kaustik/view/assets.h"
#include "kaustik/view/parameter_list.h"
#include "kaustik/view/probe.h"
#include "kaustik/view/region_request.h"
#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

constexpr uint32_t ticks_per_state = 2, ticks_per_history = 10;
constexpr int64_t most_pixels_across = 1 << 20;

void check_json(const HttpRequest& request) {
  const std::string* type = request.header("content-type");
  // Forms of other sites cannot send it.
  if (!type || !type->starts_with("application/json"))
    throw RequestError(415, "the body's type is not application/json",
                       "send Content-Type: application/json");
}

/// A text member of a command.
std::string text_of(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || !found->is_string())
    throw RequestError(400, fmt::format("there is no text '{}'", name),
                       fmt::format("give \"{}\": \"…\"", name));
  return found->get<std::string>();
}

}  // namespace

struct Routes::Call {
  HttpRequest request;
  std::shared_ptr<HttpReply> reply;
  Query query;
};

/// One way to ask for something.
struct Routes::Route {
  const char* path;
  const char* method;
  bool needs_session;
  void (Routes::*serve)(Call&);
};

const std::vector<Routes::Route>& Routes::table() {
  static const std::vector<Route> rows = {{"/session", "POST", false, &Routes::open_session},
                                          {"/state", "GET", true, &Routes::tell_state},
                                          {"/events", "GET", true, &Routes::begin_events},
                                          {"/frame", "GET", true, &Routes::poll_frame},
                                          {"/pixel", "GET", true, &Routes::probe_pixel},
                                          {"/region", "GET", true, &Routes::probe_region},
                                          {"/photons", "GET", true, &Routes::show_photons},
                                          {"/parameters", "GET", true, &Routes::list_parameters},
                                          {"/command", "POST", true, &Routes::do_command}};
  return rows;
}

Routes::Routes(Parts parts, Description description)
    : parts_(std::move(parts)),
      edits_(std::move(description)),
      polls_(parts_.shown, parts_.worker),
      photons_(parts_.seed, parts_.threads),
      saver_(std::make_shared<PictureSaver>(parts_.output_folder)) {
  if (parts_.session) return;
  edit(copy_of(edits_.current()), std::nullopt);
  parts_.engine.start();
}

void Routes::session_renders(uint64_t revision, Description description) {
  edits_ = SceneEdits(std::move(description));
  last_revision_ = revision;
  knows_distance_ = false;
}

void Routes::handle(HttpRequest request, std::shared_ptr<HttpReply> reply) {
  Query query(request.target);
  const std::string path = query.path();
  parts_.access.check_sender(request, path == "/" && request.method == "GET");
  Call call{std::move(request), std::move(reply), std::move(query)};
  for (const Route& route : table()) {
    if (path != route.path) continue;
    if (call.request.method != route.method) {
      HttpResponse response = response_of(
          RequestError(405, fmt::format("'{}' is asked for by {}", path, route.method)));
      response.headers = {{"Allow", route.method}};
      return call.reply->send(std::move(response));
    }
    if (route.needs_session) parts_.access.check_session(call.request);
    return (this->*route.serve)(call);
  }
  serve_asset(call);
}

void Routes::serve_asset(Call& call) {
  const std::string& path = call.query.path();
  const std::string name = path == "/" ? "index.html" : path.substr(1);
  for (const Asset& asset : assets()) {
    if (asset.name != name) continue;
    if (call.request.method != "GET") {
      HttpResponse response = response_of(RequestError(405, "pages are asked for by GET"));
      response.headers = {{"Allow", "GET"}};
      return call.reply->send(std::move(response));
    }
    return call.reply->send({200,
                             std::string(content_type_of(name)),
                             {},
                             std::make_shared<const std::string>(asset.bytes)});
  }
  throw RequestError(404, "there is nothing of that name", "begin with ./");
}

void Routes::open_session(Call& call) {
  check_json(call.request);
  call.query.allow_only({});
  const std::string cookie =
      parts_.access.cookie_for(text_of(parse_request_json(call.request.body), "token"));
  call.reply->send({204, "", {{"Set-Cookie", cookie}}});
}

void Routes::tell_state(Call& call) {
  call.query.allow_only({});
  call.reply->send(json_response(state(noted_status())));
}

void Routes::begin_events(Call& call) {
  call.query.allow_only({});
  streams_.check_room();
  streams_.add(call.reply->stream());
  streams_.send_to_last("state", state(noted_status()));
  streams_.send_to_last("error_history", history_.json());
}

void Routes::poll_frame(Call& call) {
  polls_.add(FrameQuery::from(call.query), std::move(call.reply));
}

void Routes::probe_pixel(Call& call) {
  call.query.allow_only({"x", "y"});
  const int x = int(call.query.required("x", 0, most_pixels_across));
  const int y = int(call.query.required("y", 0, most_pixels_across));
  parts_.worker.run([x, y, &shown = parts_.shown, reply = std::move(call.reply)] {
    try {
      reply->send(json_response(pixel_of(shown, x, y)));
    } catch (...) {
      reply->send(response_of_current_exception());
    }
  });
}

void Routes::probe_region(Call& call) {
  call.query.allow_only({"x", "y", "width", "height"});
  const PixelRegion region = {int(call.query.required("x", 0, most_pixels_across)),
                              int(call.query.required("y", 0, most_pixels_across)),
                              int(call.query.required("width", 1, most_pixels_across)),
                              int(call.query.required("height", 1, most_pixels_across))};
  parts_.worker.run([region, &shown = parts_.shown, reply = std::move(call.reply)] {
    try {
      reply->send(json_response(region_of(shown, region)));
    } catch (...) {
      reply->send(response_of_current_exception());
    }
  });
}

void Routes::show_photons(Call& call) {
  const PhotonQuery query = PhotonQuery::from(call.query);
  noted_status();
  auto scene = parts_.shown.scene();
  if (!scene) throw RequestError(409, "there is no scene yet", "ask again in a moment");
  photons_.answer(query, {copy_of(edits_.current()), std::move(scene)}, std::move(call.reply));
}

void Routes::list_parameters(Call& call) {
  call.query.allow_only({});
  noted_status();
  Json list = parameter_list(edits_.current());
  // Nothing of it can be set.
  if (parts_.session)
    list = {{"objects", Json::array()}, {"integrators", {integrator_of(edits_.current())}}};
  call.reply->send(json_response(std::move(list)));
}

void Routes::do_command(Call& call) {
  check_json(call.request);
  call.query.allow_only({});
  const Json json = parse_request_json(call.request.body);
  if (json.size() != 1)
    throw RequestError(400, fmt::format("a command of {} members", json.size()),
                       "give one: camera, set, integrator, do, refine or save");
  noted_status();
  const std::string& what = json.begin().key();
  const Json& value = json.begin().value();
  const bool is_edit = what == "camera" || what == "set" || what == "integrator";
  if (parts_.session && is_edit)
    throw RequestError(409, "this view shows what a program renders: it can't be changed here",
                       "change it in the program, by its session's edit()");
  uint64_t revision = last_revision_;
  if (what == "camera") {
    const CameraPose pose = camera_pose_from(value);
    revision = edit(edits_.with_camera(pose), pose);
  } else if (what == "set") {
    revision = edit(edits_.with_settings(value), edits_.told_pose());
  } else if (what == "integrator") {
    revision = edit(edits_.with_integrator(text_of(json, "integrator")), edits_.told_pose());
  } else if (what == "do") {
    command(text_of(json, "do"));
    revision = last_revision_;
  } else if (what == "refine") {
    refine(value);
  } else if (what == "save") {
    return save(call, value);
  } else {
    throw RequestError(400, fmt::format("there is no command '{}'", what),
                       suggest(what, {"camera", "set", "integrator", "do", "refine", "save"}));
  }
  call.reply->send(json_response({{"revision", revision}}));
}

uint64_t Routes::edit(Description description, const std::optional<CameraPose>& pose) {
  last_revision_ = parts_.engine.edit(description);
  edits_.taken(last_revision_, std::move(description), pose);
  return last_revision_;
}

void Routes::command_session(const std::string& what) {
  const SessionControls& controls = *parts_.session;
  if (what == "pause") {
    controls.pause();
  } else if (what == "resume") {
    controls.resume();
  } else if (what == "stop") {
    controls.stop();
  } else if (what == "start" || what == "reset") {
    throw RequestError(409, "this view shows what a program renders: it can't be begun here",
                       "begin it in the program, by its session's start()");
  } else {
    throw RequestError(400, fmt::format("'{}' cannot be done", what),
                       suggest(what, {"pause", "resume", "stop"}));
  }
}

void Routes::command(const std::string& what) {
  if (parts_.session) return command_session(what);
  Engine& engine = parts_.engine;
  if (what == "start") {
    engine.start();
  } else if (what == "pause") {
    engine.pause();
  } else if (what == "resume") {
    engine.resume();
  } else if (what == "stop") {
    engine.stop();
  } else if (what == "reset") {
    edit(edits_.original(), std::nullopt);
    engine.start();
  } else {
    throw RequestError(400, fmt::format("'{}' cannot be done", what),
                       suggest(what, {"start", "pause", "resume", "stop", "reset"}));
  }
}

void Routes::refine(const Json& what) {
  const RegionRequest request = region_request_from(what);
  const bool is_taken =
      parts_.session ? parts_.session->refine(request) : parts_.engine.can_refine();
  if (!is_taken)
    throw RequestError(409, "no picture is rendered at rest, so no region can have more samples",
                       "start the render, and ask when its first pass is shown");
  if (!parts_.session) parts_.engine.refine(request);
}

void Routes::save(Call& call, const Json& what) {
  if (!what.is_object()) throw RequestError(400, "'save' is no object", "give {\"name\": \"…\"}");
  const std::string name = text_of(what, "name");
  parts_.worker.run([name, saver = saver_, &shown = parts_.shown, reply = std::move(call.reply)] {
    try {
      const std::string path = saver->path_for(name);
      const auto image = shown.finished_snapshot();
      if (!image) throw RequestError(409, "there is no picture yet", "save it in a moment");
      saver->save(*image, name);
      reply->send(json_response({{"file", path}}));
    } catch (...) {
      reply->send(response_of_current_exception());
    }
  });
}

EngineStatus Routes::noted_status() {
  EngineStatus status = parts_.shown.status();
  edits_.note(status.revision, status.refusal ? status.refused_revision : 0);
  learn_of_scene();
  return status;
}

Json Routes::state(const EngineStatus& status) const {
  const auto scene = parts_.shown.scene();
  return state_report(parts_.shown, status,
                      {parts_.scene, integrator_of(edits_.current()), layers_,
                       edits_.camera(scene.get()), !parts_.session});
}

void Routes::learn_of_scene() {
  if (knows_distance_) return;
  const auto scene = parts_.shown.scene();
  if (!scene) return;
  knows_distance_ = true;
  edits_.set_distance(distance_ahead(*scene));
}

void Routes::learn_of_layers(const EngineStatus& status) {
  const auto snapshot = parts_.shown.snapshot();
  if (!snapshot || snapshot->is_moving || snapshot->kind != Snapshot::Kind::passes ||
      snapshot->revision != status.revision || layers_revision_ == status.revision)
    return;
  layers_revision_ = status.revision;
  // A film may be in use for a while.
  parts_.worker.run([this, &shown = parts_.shown, post = parts_.post] {
    std::vector<std::string> names;
    shown.look_at_film([&](const Film& film) { names = layer_names(film.layers()); });
    if (names.size() > 1) post([this, names] { layers_ = names; });
  });
}

void Routes::tick() {
  polls_.serve();
  const EngineStatus status = noted_status();
  learn_of_layers(status);
  const auto snapshot = parts_.shown.snapshot();
  if (history_.note(status, snapshot && snapshot->is_moving)) has_new_error_ = true;
  ++ticks_;
  if (streams_.empty()) return;
  if (ticks_ % ticks_per_state == 0) {
    const Json now = state(status);
    if (std::string text = text_of_json(now); text != last_state_) {
      last_state_ = std::move(text);
      streams_.send("state", now);
    }
  }
  if (has_new_error_ && ticks_ % ticks_per_history == 0) {
    has_new_error_ = false;
    streams_.send("error_history", history_.json());
  }
}

void Routes::clear() {
  polls_.clear();
  streams_.clear();
}

}  // namespace kaustik::view
