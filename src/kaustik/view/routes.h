#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/live/watched.h"
#include "kaustik/view/access.h"
#include "kaustik/view/event_streams.h"
#include "kaustik/view/frame_polls.h"
#include "kaustik/view/http_message.h"
#include "kaustik/view/photon_answers.h"
#include "kaustik/view/picture_saver.h"
#include "kaustik/view/query.h"
#include "kaustik/view/scene_edits.h"
#include "kaustik/view/shown_session.h"
#include "kaustik/view/view_report.h"
#include "kaustik/view/worker.h"

namespace kaustik::view {

/// What the server does for each request, and by itself from time to time: all that clients have in
/// common. In the server's thread.
class Routes {
 public:
  struct Parts {
    Engine& engine;  // All four must outlive the routes.
    const Watched& shown;
    Worker& worker;
    Access& access;
    std::string scene;                                ///< its name, for pages
    std::string output_folder;                        ///< that pictures are saved in
    std::function<void(std::function<void()>)> post;  ///< runs it in the server's thread
    uint64_t seed = 0;                                ///< of the engine's sessions
    int threads = 0;                                  ///< of the engine's sessions; 0: all
    /// Absent: the engine renders what viewers ask for, and is shown. Else nobody gives it anything
    /// to render: what is shown is steered elsewhere.
    std::optional<SessionControls> session = std::nullopt;
  };
  /// Gives the engine the description to render, or shows what it is that is rendered.
  Routes(Parts parts, Description description);

  /// Answers, or keeps the reply for later. Throws what becomes the answer.
  void handle(HttpRequest request, std::shared_ptr<HttpReply> reply);
  /// There may be a new picture.
  void picture_changed() { polls_.serve(); }
  /// To be called a few times a second.
  void tick();
  /// A session renders this from now on.
  void session_renders(uint64_t revision, Description description);
  /// A message for those who look.
  void log(const std::string& level, const std::string& text) { streams_.log(level, text); }
  /// Lets go of all clients.
  void clear();

 private:
  struct Call;
  struct Route;
  static const std::vector<Route>& table();

  void serve_asset(Call& call);
  void open_session(Call& call);
  void tell_state(Call& call);
  void begin_events(Call& call);
  void poll_frame(Call& call);
  void probe_pixel(Call& call);
  void probe_region(Call& call);
  void show_photons(Call& call);
  void list_parameters(Call& call);
  void do_command(Call& call);

  uint64_t edit(Description description, const std::optional<CameraPose>& pose);
  void command(const std::string& what);
  void command_session(const std::string& what);
  /// More samples in a region.
  void refine(const Json& what);
  void save(Call& call, const Json& what);
  /// Takes in what has become of the edits, and what the scene tells.
  EngineStatus noted_status();
  Json state(const EngineStatus& status) const;
  void learn_of_scene();
  void learn_of_layers(const EngineStatus& status);

  Parts parts_;
  SceneEdits edits_;
  uint64_t last_revision_ = 0;
  EventStreams streams_;
  FramePolls polls_;
  PhotonAnswers photons_;
  std::shared_ptr<PictureSaver> saver_;
  ErrorHistory history_;
  bool has_new_error_ = false;  ///< in the history, and those who listen were not told yet
  std::vector<std::string> layers_ = {""};
  uint64_t layers_revision_ = 0;  ///< that the layers are known of, or asked for
  bool knows_distance_ = false;
  uint32_t ticks_ = 0;
  std::string last_state_;
};

}  // namespace kaustik::view
