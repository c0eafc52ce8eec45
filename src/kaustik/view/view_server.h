#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "kaustik/live/engine.h"
#include "kaustik/view/http_server.h"
#include "kaustik/view/shown_session.h"

namespace kaustik::view {

/// How a scene is shown to browsers.
struct ViewSettings {
  std::string scene;  ///< its name, for pages
  /// The recipe's changes are made once, before the viewers'; it moves by recipe_of_moving_views()
  /// unless it says otherwise. Snapshots have no layers, whatever it says.
  EngineSettings engine;
  std::string address = "127.0.0.1";  ///< to listen to
  uint16_t port = 0;                  ///< 0: any that is free
  std::string token;                  ///< that lets viewers in; "": a random one
  std::string output_folder = ".";    ///< that viewers may save pictures in
  HttpLimits limits;
};

/// Renders a scene for those who watch and change it in browsers: the page, and behind it an Engine
/// over HTTP (docs/guides/live_view.md). Nothing else is served, and no file is read for who asks.
class ViewServer {
 public:
  /// Begins at once. Messages come from other threads. Throws Error: for an address or port that
  /// cannot be had, and for changes of the recipe that cannot be made; what else is wrong with the
  /// scene its viewers are told.
  ViewServer(Description description, ViewSettings settings, Messages messages = {});
  /// Shows a session's render of a description and renders nothing itself. Of the settings' engine
  /// only the session counts, for photons that viewers ask for.
  ViewServer(ShownSession session, Description description, ViewSettings settings,
             Messages messages = {});
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  uint16_t port() const;
  /// Whether only this machine can reach it.
  bool is_local() const;
  const std::string& token() const;
  /// What to open in a browser on this machine, with the token.
  std::string url() const;
  const Engine& engine() const;
  /// The session renders another description, in this revision of what is shown. It has one camera.
  void session_renders(uint64_t revision, Description description);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kaustik::view
